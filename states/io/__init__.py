"""States that switch digital outputs and read digital inputs."""

ICON = "output"
"""The name of the icon of these states."""
