"""Hexapods of a cell: how they are written, the geometry of their legs, and what a document may say of them."""

from engine.document.hexapods.hexapod_geometry import beyond_limits, leg_lengths_m, path_beyond_limits
from engine.document.hexapods.hexapod_spec import HexapodSpec, JointPattern, placed_hexapod

__all__ = [
    "HexapodSpec",
    "JointPattern",
    "beyond_limits",
    "leg_lengths_m",
    "path_beyond_limits",
    "placed_hexapod",
]
