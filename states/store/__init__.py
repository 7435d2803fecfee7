"""States that read and write the named entries of the store."""

ICON = "store"
"""The name of the icon of these states."""
