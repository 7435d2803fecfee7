"""States that detect objects with the cameras of a cell."""

ICON = "camera"
"""The name of the icon of these states."""
