"""States that concern the whole cell: positions of parts, and simulated people."""

ICON = "cell"
"""The name of the icon of these states."""
