"""States that move an arm: in joint space, to a pose, along a straight line."""

ICON = "path"
"""The name of the icon of these states."""
