"""The radar simulator: scenarios, ships, radar, clutter, errors of sensors."""
