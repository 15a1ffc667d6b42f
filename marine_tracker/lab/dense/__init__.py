"""A crowd of plots: what it costs, and what becomes of the targets elsewhere."""
