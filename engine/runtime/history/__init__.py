"""State of a run derived from its events: its position, and what can be resumed, changed or undone.

A run itself needs its checkpoints only, so each name is imported with its first use.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "LOG_LINES": "engine.runtime.history.live_run",
    "MAX_WATCHES": "engine.runtime.history.watch",
    "LiveRun": "engine.runtime.history.live_run",
    "LiveRunChange": "engine.runtime.history.live_run",
    "LogLine": "engine.runtime.history.event_log",
    "NodeLive": "engine.runtime.history.run_state",
    "NodeStep": "engine.runtime.history.run_state",
    "ResumeDecisionRequired": "engine.runtime.history.resume",
    "ResumeQuestion": "engine.runtime.history.resume",
    "RunReducer": "engine.runtime.history.run_reducer",
    "RunState": "engine.runtime.history.run_state",
    "RunStateChange": "engine.runtime.history.run_state",
    "RunView": "engine.runtime.history.run_view",
    "ScopeView": "engine.runtime.history.userdata_history",
    "UserdataHistory": "engine.runtime.history.userdata_history",
    "Watch": "engine.runtime.history.watch",
    "WatchValue": "engine.runtime.history.watch",
    "evaluate_watch": "engine.runtime.history.watch",
    "event_text": "engine.runtime.history.event_texts",
    "log_line": "engine.runtime.history.event_log",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
