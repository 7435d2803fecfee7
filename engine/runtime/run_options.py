"""Options of a run: operator, autonomy, breakpoints and time-outs."""

from __future__ import annotations

from dataclasses import dataclass

from engine.runtime.control.autonomy import AutonomyLevel
from engine.runtime.control.breakpoint import Breakpoint
from engine.runtime.control.control import LossPolicy


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """What a run is started with; all of it but the time-outs can be changed while it goes on."""

    autonomy: AutonomyLevel = "full"
    """Outcomes that require less pass by themselves; matters while an operator is there or demanded."""
    demand_operator: bool = False
    """Whether rules of autonomy hold although no operator is attached."""
    breakpoints: tuple[Breakpoint, ...] = ()
    start_paused: bool = False
    loss_policy: LossPolicy = "hold"
    loss_timeout_s: float = 5.0
    abandon_after_s: float = 30.0
    """How long a state may take to clean up after a stop before the run goes on without it."""
