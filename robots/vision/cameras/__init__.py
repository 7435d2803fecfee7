"""Depth cameras: their specification, and how images are rendered from a copy of a simulated cell."""
