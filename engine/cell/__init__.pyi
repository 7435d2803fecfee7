# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.cell.camera_coverage import CameraCoverage, RegionCoverage
from engine.cell.cell_connection import CellConnection
from engine.cell.cell_items import CellItem, CellItems, items_of_cell, named_items
from engine.cell.device_details import DeviceDetails, devices_of_cell
from engine.cell.mesh_defect import MeshDefect
from engine.cell.open_cell import OpenCell
from engine.cell.reach_map import ReachDirection, ReachLevel, ReachPoint
from engine.cell.rest_contacts import RestContact
from engine.cell.robot_models import ModelNames, RobotModels, RobotSummary, model_names, tool_kinds
from engine.cell.scene_file import SceneFile, SceneFiles, SceneFormat
from engine.cell.tool_kind import ToolKind
from engine.cell.urdf_module import UrdfModule

__all__ = [
    "CameraCoverage",
    "CellConnection",
    "CellItem",
    "CellItems",
    "DeviceDetails",
    "MeshDefect",
    "ModelNames",
    "OpenCell",
    "ReachDirection",
    "ReachLevel",
    "ReachPoint",
    "RegionCoverage",
    "RestContact",
    "RobotModels",
    "RobotSummary",
    "SceneFile",
    "SceneFiles",
    "SceneFormat",
    "ToolKind",
    "UrdfModule",
    "devices_of_cell",
    "items_of_cell",
    "model_names",
    "named_items",
    "tool_kinds",
]
