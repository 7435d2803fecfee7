"""States that need no robot: waiting, logging, deciding, setting values."""

ICON = "flow"
"""The name of the icon of these states."""
