"""States that pick and place a part: approach, tool, and planning scene."""

ICON = "part"
"""The name of the icon of these states."""
