"""States that open, close and check a two-finger gripper."""

ICON = "gripper"
"""The name of the icon of these states."""
