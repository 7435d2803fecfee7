"""States of a hand that closes with one motor."""

ICON = "hand"
"""The name of the icon of these states."""
