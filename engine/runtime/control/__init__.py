"""Operator control of one run: pause, step, breakpoints, lock, repeat, force, autonomy, hot change.

Operator consoles call `Control`; the nodes of the run ask `Gate` whether they may proceed.
"""

from engine.runtime.control.autonomy import LEVELS, AutonomyLevel
from engine.runtime.control.breakpoint import (
    Breakpoint,
    GatePoint,
    breakpoints_file,
    load_breakpoints,
    save_breakpoints,
)
from engine.runtime.control.control import Control, ControlView, LossPolicy
from engine.runtime.control.gate import Gate, GateWait
from engine.runtime.control.single_step import StepMode

__all__ = [
    "LEVELS",
    "AutonomyLevel",
    "Breakpoint",
    "Control",
    "ControlView",
    "Gate",
    "GatePoint",
    "GateWait",
    "LossPolicy",
    "StepMode",
    "breakpoints_file",
    "load_breakpoints",
    "save_breakpoints",
]
