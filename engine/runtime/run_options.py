"""Options of a run: operator, autonomy, breakpoints and timeouts."""

from __future__ import annotations

from dataclasses import dataclass

from engine.runtime.control.autonomy import AutonomyLevel
from engine.runtime.control.breakpoint import Breakpoint
from engine.runtime.control.control import LossPolicy


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """Options of a run; all but the timeouts can be changed while it executes."""

    autonomy: AutonomyLevel = "full"
    """Outcomes that require less pass without confirmation; applies while an operator is attached or demanded."""
    demand_operator: bool = False
    """Whether autonomy rules apply although no operator is attached."""
    breakpoints: tuple[Breakpoint, ...] = ()
    start_paused: bool = False
    loss_policy: LossPolicy = "hold"
    loss_timeout_s: float = 5.0
    abandon_after_s: float = 30.0
    """Maximum clean-up time of a state after a stop, before the run abandons it."""
