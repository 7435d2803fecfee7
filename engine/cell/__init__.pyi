# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.cell.camera_coverage import CameraCoverage, RegionCoverage
from engine.cell.cell_connection import CellConnection
from engine.cell.cell_items import CellItem, CellItems, items_of_cell, named_items
from engine.cell.open_cell import OpenCell
from engine.cell.robot_models import RobotModels, RobotSummary, tool_kinds
from engine.cell.tool_kind import ToolKind

__all__ = [
    "CameraCoverage",
    "CellConnection",
    "CellItem",
    "CellItems",
    "OpenCell",
    "RegionCoverage",
    "RobotModels",
    "RobotSummary",
    "ToolKind",
    "items_of_cell",
    "named_items",
    "tool_kinds",
]
