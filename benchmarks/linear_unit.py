"""How near to its places an arm pulls its own base on a passive linear unit, with and without errors of the arm.

`python -P benchmarks/linear_unit.py --seeds 20` pulls the base of `behaviors/cells/linear_unit.yaml` 0.8 m along the
rail and back in one open cell a seed, and prints a table of what the world shows after the arm let go.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np
from msgspec.structs import replace

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import Cell, RealismName, load_behavior, load_cell
from engine.journal import NullJournal
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.record.skill_port import BusPort
from engine.runtime.run import Run
from engine.skills.linear_units import ReadLinearUnit

BEHAVIORS = Path(__file__).resolve().parents[1] / "behaviors"
PLACES = ("north", "south")


@dataclass(frozen=True, kw_only=True)
class Pull:
    """One pull to a place: how the behavior ended, and how far the carriage is from the place then."""

    realism: str
    by: str
    seed: int
    place: str
    outcome: str
    error_mm: float


def cell_with(realism: RealismName) -> Cell:
    """Return the cell with another realism of its arm."""
    cell = load_cell(BEHAVIORS / "cells" / "linear_unit.yaml")
    world = cell.document.world
    assert world is not None
    document = replace(cell.document, world=replace(world, realism=realism))
    return Cell(document=document, file=cell.file, source=cell.source)


async def pulls(
    realism: RealismName, by: str, seed: int, folder: Path, *, done_one: Callable[[Pull], None]
) -> list[Pull]:
    """Pull the base to all places; `done_one` is called with each."""
    done: list[Pull] = []
    plan = new_plan(load_behavior(BEHAVIORS / "linear_unit" / "pull.yaml"), load_states())
    async with OpenCell(cell_with(realism), seed=seed, store_path=str(folder / "store.db")) as cell:
        for place in PLACES:
            run = Run(
                plan,
                skills=BusPort(cell.bus),
                run=place,
                bus=cell.bus,
                parameters={"place": place, "measured_by": by},
                inputs={},
                seed=seed,
                supervision=None,
                journal=NullJournal().begin(place, behavior="", document="", started_unix_s=0.0),
            )
            outcome = (await run.execute()).outcome
            at = await cell.bus.call(ReadLinearUnit(place=place), to="rail")
            error_mm = 1e3 * (at.place_m - at.target_m)
            pull = Pull(realism=realism, by=by, seed=seed, place=place, outcome=str(outcome), error_mm=error_mm)
            done.append(pull)
            done_one(pull)
            if outcome in (None, "failed"):
                break  # the arm still holds the post
    return done


def write(file: Path | None, pull: Pull) -> None:
    """Append a pull to a file, if there is one."""
    if file is not None:
        with file.open("a", encoding="utf-8") as lines:
            lines.write(json.dumps(asdict(pull)) + "\n")


def row(done: list[Pull]) -> str:
    """Return the row of a table: how many of them are at their place, with median, 95th percentile and maximum."""
    errors = np.array([abs(each.error_mm) for each in done])
    good = sum(each.outcome == "at_place" and abs(each.error_mm) <= 1.0 for each in done)
    spread = f"{np.median(errors):.2f} / {np.quantile(errors, 0.95):.2f} / {errors.max():.2f}"
    return f"| {done[0].realism} | {done[0].by} | {len(done)} | {good} | {spread} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20, help="seeds with errors of the arm (without, all are alike)")
    parser.add_argument("--by", choices=("scale", "arm"), nargs="+", default=["scale", "arm"], help="what measures")
    parser.add_argument("--realism", choices=("ideal", "typical", "poor"), nargs="+", default=["ideal", "typical"])
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every pull to FILE, one a line")
    options = parser.parse_args()
    print("| errors of the arm | measured by | pulls of 0.8 m | within 1 mm | mm: median / 95 % / max |")
    print("|---|---|---|---|---|")
    for realism in options.realism:
        for by in options.by:
            done: list[Pull] = []
            for seed in range(1, 2 if realism == "ideal" else options.seeds + 1):
                with tempfile.TemporaryDirectory() as folder:
                    done += run_virtual(pulls(realism, by, seed, Path(folder), done_one=partial(write, options.json)))
            print(row(done), flush=True)


if __name__ == "__main__":
    main()
