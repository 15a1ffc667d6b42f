"""Ships and land as a high-resolution radar sees them."""
