"""Operator options of `flexcell run` and `flexcell resume`."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from engine.document.python_name import is_python_name
from engine.runtime.control import AutonomyLevel, LossPolicy, load_breakpoints
from engine.runtime.run_options import RunOptions

Autonomy = Annotated[
    AutonomyLevel | None,
    typer.Option(
        help="Autonomy level: outcomes that require a lower level pass without the operator; at `full`, only those"
        " that require `full` wait."
    ),
]
Operator = Annotated[
    bool, typer.Option("--operator", help="Read operator commands from the terminal; `help` lists them.")
]
Loss = Annotated[
    LossPolicy, typer.Option("--operator-loss", help="Reaction of the run when the input of --operator ends.")
]
Demand = Annotated[
    bool,
    typer.Option("--demand-operator", help="Outcomes that require an operator wait even while none is connected."),
]
Breakpoints = Annotated[
    bool, typer.Option("--breakpoints", help="Use the breakpoints file of the behavior even without --operator.")
]
Paused = Annotated[bool, typer.Option("--paused", help="Start the run paused.")]


@dataclass(frozen=True, kw_only=True)
class OperatorOptions:
    """Values of the operator options."""

    autonomy: AutonomyLevel | None
    operator: bool
    loss: LossPolicy
    demand: bool
    breakpoints: bool
    paused: bool

    def supervision(self, file: Path, *, autonomy: AutonomyLevel = "full") -> RunOptions:
        """Return the supervision of a run of the behavior in `file`; `autonomy` applies if no option sets it.

        Raises:
            DocumentError: the breakpoints file is invalid.
        """
        if self.autonomy is not None and not (self.operator or self.demand):
            sys.stderr.write("flexcell: --autonomy has no effect without --operator or --demand-operator\n")
        uses_breakpoints = (self.operator or self.breakpoints) and not is_python_name(str(file))
        return RunOptions(
            autonomy=self.autonomy or autonomy,
            demand_operator=self.demand,
            breakpoints=load_breakpoints(file) if uses_breakpoints else (),
            start_paused=self.paused,
            loss_policy=self.loss,
        )
