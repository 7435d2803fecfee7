"""Findings about the cell: its document, and the names and entries of it that a behavior uses."""
