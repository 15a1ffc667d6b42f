"""AIS: sentences, reports, ships in time, and which of them is which radar track."""
