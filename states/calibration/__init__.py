"""States that calibrate tools and frames from poses in which an arm touches points."""

ICON = "cell"
"""The name of the icon of these states."""
