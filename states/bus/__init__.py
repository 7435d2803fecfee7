"""States for the skill bus: wait for messages, read and publish them, call services and send goals by name."""

ICON = "broadcast"
"""The name of the icon of these states."""
