"""Arguments and options that name a sweep, the same for all commands that work on one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

File = Annotated[Path, typer.Argument(help="A sweep document, or a behavior with --vary.", show_default=False)]
Results = Annotated[Path, typer.Option(help="File in which results are found and saved.")]
Cell = Annotated[Path | None, typer.Option(help="Cell of all runs; by default that of the behavior.")]
Simulate = Annotated[
    list[str] | None,
    typer.Option(help="A device to simulate instead of its driver, or `all`; may be repeated. No real one is driven."),
]
Parameter = Annotated[
    list[str] | None, typer.Option("-p", "--parameter", help="Parameter of all runs, NAME=VALUE; may be repeated.")
]
Vary = Annotated[
    list[str] | None,
    typer.Option(
        help="A factor, may be repeated: NAME=0.3..1.0, NAME=1,2,5, NAME=log(0.01..10), NAME=normal(0, 0.004). NAME is "
        "a parameter, displace.PART.x_m, cell.PATH, inputs.KEY, seed, faults or substitutes."
    ),
]
Runs = Annotated[int | None, typer.Option(help="Runs at most.", min=1)]
Seed = Annotated[int | None, typer.Option(help="Seed from which factors and seeds of runs are drawn.", min=0)]
Design = Annotated[
    Literal["random", "grid", "latin_hypercube", "sobol"] | None, typer.Option(help="How factors are combined.")
]
Search = Annotated[
    str | None,
    typer.Option(
        help="Search for failures instead: `failure`, or towards a number of runs that succeed, `least NAME` or `most "
        "NAME`; `none` for the design of a document with a search."
    ),
]
Method = Annotated[Literal["cross_entropy", "optuna"] | None, typer.Option(help="With --search: how it chooses runs.")]
