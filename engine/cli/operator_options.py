"""The options by which `flexcell run` and `flexcell resume` put a run under an operator."""

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
    typer.Option(help="Outcomes that require less pass without the operator; `full` passes all but what requires it."),
]
Operator = Annotated[
    bool, typer.Option("--operator", help="Take commands from the terminal and ask there; `help` lists them.")
]
Loss = Annotated[
    LossPolicy, typer.Option("--operator-loss", help="When the input of --operator ends: what the run does then.")
]
Demand = Annotated[
    bool, typer.Option("--demand-operator", help="Ask for outcomes also while no operator is there; they wait.")
]
Breakpoints = Annotated[
    bool, typer.Option("--breakpoints", help="Use the breakpoints beside the behavior also without --operator.")
]
Paused = Annotated[bool, typer.Option("--paused", help="Begin paused.")]


@dataclass(frozen=True, kw_only=True)
class OperatorOptions:
    """What the options said."""

    autonomy: AutonomyLevel | None
    operator: bool
    loss: LossPolicy
    demand: bool
    breakpoints: bool
    paused: bool

    def supervision(self, file: Path, *, autonomy: AutonomyLevel = "full") -> RunOptions:
        """Return how a run of the behavior in `file` is watched over, at `autonomy` where no option says it.

        Raises:
            DocumentError: the breakpoints file is not valid.
        """
        if self.autonomy is not None and not (self.operator or self.demand):
            sys.stderr.write("flexcell: without --operator or --demand-operator every outcome passes\n")
        wanted = (self.operator or self.breakpoints) and not is_python_name(str(file))
        return RunOptions(
            autonomy=self.autonomy or autonomy,
            demand_operator=self.demand,
            breakpoints=load_breakpoints(file) if wanted else (),
            start_paused=self.paused,
            loss_policy=self.loss,
        )
