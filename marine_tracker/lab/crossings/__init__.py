"""Two ships that meet: how often their tracks are swapped."""
