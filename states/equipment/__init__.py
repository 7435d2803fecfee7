"""States of the devices of a cell: vices, clamps, slides, lamps."""

ICON = "output"
"""The name of the icon of its states."""
