"""The web page that shows the radar picture."""
