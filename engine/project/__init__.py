"""The composition root: the one place that opens a cell and makes runs in it, and sessions of several runs.

`cell_runner` composes: a `RunRequest` becomes a run with its cell, bus, journal, recording and faults. The command
line, the dashboard, the pytest plugin, scripts and notebooks all start their runs there. A command loads only what it
needs, so each name is imported with its first use.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "ArmRecovery": "engine.project.cell_stop",
    "BusInspector": "engine.project.bus_inspector",
    "CellReopening": "engine.project.cell_reopening",
    "CellRunner": "engine.project.cell_runner",
    "CellStop": "engine.project.cell_stop",
    "CompletedRun": "engine.project.headless_run",
    "DeviceRecovery": "engine.project.cell_stop",
    "DrivenDeviceChoice": "engine.project.cell_reopening",
    "GoalInfo": "engine.project.bus_inspector",
    "InterruptedRun": "engine.project.session_run",
    "ParameterInfo": "engine.project.bus_inspector",
    "Project": "engine.project.project",
    "RunOperator": "engine.project.session_operators",
    "RunPosition": "engine.project.run_request",
    "RunRequest": "engine.project.run_request",
    "Session": "engine.project.session",
    "SkillInfo": "engine.project.bus_inspector",
    "StartData": "engine.project.run_request",
    "StopRecovery": "engine.project.stop_recovery",
    "StoppedDevice": "engine.project.cell_stop",
    "StoppedRun": "engine.project.cell_stop",
    "TopicInfo": "engine.project.bus_inspector",
    "TopicStatistics": "engine.project.bus_inspector",
    "open_cell": "engine.project.cell_runner",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
