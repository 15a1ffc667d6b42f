"""AIS beside radar: joined, told when it is wrong, fused."""
