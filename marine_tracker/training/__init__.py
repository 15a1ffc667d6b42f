"""How the shipped weights and settings are found, from simulated tracks."""
