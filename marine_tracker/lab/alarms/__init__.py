"""How often the alarm of danger sounds, and how often it should."""
