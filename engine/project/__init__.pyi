# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.project.bus_inspector import BusInspector, GoalInfo, ParameterInfo, SkillInfo, TopicInfo, TopicStatistics
from engine.project.cell_reopening import CellReopening, DrivenDeviceChoice
from engine.project.cell_runner import CellRunner, open_cell
from engine.project.cell_stop import ArmRecovery, CellStop, DeviceRecovery, StoppedDevice, StoppedRun
from engine.project.headless_run import CompletedRun
from engine.project.project import Project
from engine.project.run_request import RunPosition, RunRequest, StartData
from engine.project.session import Session
from engine.project.session_operators import RunOperator
from engine.project.session_run import InterruptedRun
from engine.project.stop_recovery import StopRecovery

__all__ = [
    "ArmRecovery",
    "BusInspector",
    "CellReopening",
    "CellRunner",
    "CellStop",
    "CompletedRun",
    "DeviceRecovery",
    "DrivenDeviceChoice",
    "GoalInfo",
    "InterruptedRun",
    "ParameterInfo",
    "Project",
    "RunOperator",
    "RunPosition",
    "RunRequest",
    "Session",
    "SkillInfo",
    "StartData",
    "StopRecovery",
    "StoppedDevice",
    "StoppedRun",
    "TopicInfo",
    "TopicStatistics",
    "open_cell",
]
