"""Files of recorded radar and of tracks."""
