"""Options of a run: operator, autonomy, breakpoints and timeouts."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.runtime.control.autonomy import AutonomyLevel
from engine.runtime.control.breakpoint import Breakpoint
from engine.runtime.control.control import LossPolicy


class Supervision(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How operators watch over a run; `flexcell run --help` explains the same options.

    `autonomy` applies while an operator is attached or demanded: outcomes that require less pass without confirmation.
    With `demand_operator` it applies although no operator is attached. `loss_policy` applies when the last operator has
    been lost for `loss_timeout_s`.
    """

    autonomy: AutonomyLevel = "full"
    demand_operator: bool = False
    start_paused: bool = False
    loss_policy: LossPolicy = "hold"
    loss_timeout_s: Annotated[float, Meta(ge=0.0)] = 5.0


class RunOptions(Supervision, frozen=True, kw_only=True, forbid_unknown_fields=False):
    """Options of a run; all but the timeouts can be changed while it executes.

    `abandon_after_s` is the maximum clean-up time of a state after a stop, before the run abandons it.
    """

    breakpoints: tuple[Breakpoint, ...] = ()
    abandon_after_s: float = 30.0
