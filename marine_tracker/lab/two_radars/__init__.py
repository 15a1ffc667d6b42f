"""One picture from two radars."""
