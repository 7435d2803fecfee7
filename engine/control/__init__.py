"""Operator control of one run: pause, step, breakpoints, lock, repeat, force, autonomy, hot change.

`Control` is what an operator's console talks to; `Gate` is where the nodes of the run ask whether
they may go on.
"""

from engine.control.autonomy import LEVELS, AutonomyLevel
from engine.control.breakpoint import Breakpoint, breakpoints_file, load_breakpoints, save_breakpoints
from engine.control.control import Control, ControlView, LossPolicy
from engine.control.gate import Gate, Waiting

__all__ = [
    "LEVELS",
    "AutonomyLevel",
    "Breakpoint",
    "Control",
    "ControlView",
    "Gate",
    "LossPolicy",
    "Waiting",
    "breakpoints_file",
    "load_breakpoints",
    "save_breakpoints",
]
