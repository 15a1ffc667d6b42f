"""Paper 002: adaptive alpha-beta filters for HF radar."""
