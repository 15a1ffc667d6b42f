"""Ships with a length: clusters of cells, sizes and headings, land."""
