# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.runtime.history.event_log import LogLine, log_line
from engine.runtime.history.event_texts import event_text
from engine.runtime.history.live_run import LOG_LINES, LiveRun, LiveRunChange
from engine.runtime.history.resume import ResumeDecisionRequired, ResumeQuestion
from engine.runtime.history.run_reducer import RunReducer
from engine.runtime.history.run_state import NodeLive, NodeStep, RunState, RunStateChange
from engine.runtime.history.run_view import RunView
from engine.runtime.history.userdata_history import ScopeView, UserdataHistory
from engine.runtime.history.watch import MAX_WATCHES, Watch, WatchValue, evaluate_watch

__all__ = [
    "LOG_LINES",
    "MAX_WATCHES",
    "LiveRun",
    "LiveRunChange",
    "LogLine",
    "NodeLive",
    "NodeStep",
    "ResumeDecisionRequired",
    "ResumeQuestion",
    "RunReducer",
    "RunState",
    "RunStateChange",
    "RunView",
    "ScopeView",
    "UserdataHistory",
    "Watch",
    "WatchValue",
    "evaluate_watch",
    "event_text",
    "log_line",
]
