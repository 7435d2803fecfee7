"""The engine: documents, runs, bus, journal and store; independent of robots and browsers.

The names of `__all__` are its face for scripts and notebooks: `from engine import Project`. Each is imported with
its first use, so that importing the engine stays cheap and a state does not load what executes it. The engine itself
imports from its rooms only. `__init__.pyi` tells type checkers where each name comes from.

Importing the engine makes every module of the project prepare its message and document types on import;
two threads that prepared a type at once would crash the process, see `engine.type_preparation`.
"""

from engine.lazy_face import lazy_face
from engine.type_preparation import prepare_on_import

_HOMES = {
    "Action": "engine.skill",
    "Behavior": "engine.document",
    "Cell": "engine.document",
    "CellRunner": "engine.project.cell_runner",
    "Clock": "engine.clock",
    "CompletedRun": "engine.project.headless_run",
    "Context": "engine.state",
    "ControlError": "engine.errors",
    "DocumentError": "engine.errors",
    "Event": "engine.event",
    "Finding": "engine.check",
    "FlexcellError": "engine.errors",
    "OpenCell": "engine.cell.open_cell",
    "Outcome": "engine.state",
    "Project": "engine.project.project",
    "RobotError": "engine.errors",
    "Run": "engine.runtime.run",
    "RunRequest": "engine.project.run_request",
    "Service": "engine.skill",
    "Session": "engine.project.session",
    "Skill": "engine.skill",
    "SkillBus": "engine.bus",
    "State": "engine.state",
    "open_cell": "engine.project.cell_runner",
    "run_sweep": "engine.sweep",
    "run_virtual": "engine.clock",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)

prepare_on_import("engine", "states", "robots", "editor_web", "behaviors")
