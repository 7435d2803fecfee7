"""States that change the planning scene: obstacles, attached parts and allowed contacts."""

ICON = "scene"
"""The name of the icon of these states."""
