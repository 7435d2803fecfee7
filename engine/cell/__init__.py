"""An open cell: its devices and their connection, its store, and the names that behaviors may use.

The check reads the names of a cell without opening one, so each name is imported with its first use.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "CameraCoverage": "engine.cell.camera_coverage",
    "CellConnection": "engine.cell.cell_connection",
    "CellItem": "engine.cell.cell_items",
    "CellItems": "engine.cell.cell_items",
    "DeviceDetails": "engine.cell.device_details",
    "MeshDefect": "engine.cell.mesh_defect",
    "ModelNames": "engine.cell.robot_models",
    "OpenCell": "engine.cell.open_cell",
    "ReachDirection": "engine.cell.reach_map",
    "ReachLevel": "engine.cell.reach_map",
    "ReachPoint": "engine.cell.reach_map",
    "RegionCoverage": "engine.cell.camera_coverage",
    "RestContact": "engine.cell.rest_contacts",
    "RobotModels": "engine.cell.robot_models",
    "RobotSummary": "engine.cell.robot_models",
    "SceneFile": "engine.cell.scene_file",
    "SceneFiles": "engine.cell.scene_file",
    "SceneFormat": "engine.cell.scene_file",
    "ToolKind": "engine.cell.tool_kind",
    "UrdfModule": "engine.cell.urdf_module",
    "devices_of_cell": "engine.cell.device_details",
    "items_of_cell": "engine.cell.cell_items",
    "model_names": "engine.cell.robot_models",
    "named_items": "engine.cell.cell_items",
    "tool_kinds": "engine.cell.robot_models",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
