"""States that switch digital outputs."""

ICON = "output"
"""The name of the icon of these states."""
