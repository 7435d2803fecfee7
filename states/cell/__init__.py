"""States that concern the whole cell: positions of parts, and simulated people."""
