# The face of the engine for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.check import Finding
from engine.clock import Clock, run_virtual
from engine.document import Behavior, Cell
from engine.errors import (
    ControlError,
    DocumentError,
    FlexcellError,
    RobotError,
)
from engine.event import Event
from engine.project.cell_runner import CellRunner, open_cell
from engine.project.headless_run import CompletedRun
from engine.project.project import Project
from engine.project.run_request import RunRequest
from engine.project.session import Session
from engine.runtime.run import Run
from engine.skill import Action, Service, Skill
from engine.state import Context, Outcome, State
from engine.sweep import run_sweep

__all__ = [
    "Action",
    "Behavior",
    "Cell",
    "CellRunner",
    "Clock",
    "CompletedRun",
    "Context",
    "ControlError",
    "DocumentError",
    "Event",
    "Finding",
    "FlexcellError",
    "OpenCell",
    "Outcome",
    "Project",
    "RobotError",
    "Run",
    "RunRequest",
    "Service",
    "Session",
    "Skill",
    "SkillBus",
    "State",
    "open_cell",
    "run_sweep",
    "run_virtual",
]
