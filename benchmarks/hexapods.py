"""How near to its named poses an arm brings a passive hexapod, with and without errors of the arm.

`python -P benchmarks/hexapods.py --seeds 20` moves both hexapods of `behaviors/cells/hexapods.yaml` to all of their
poses, one after the other in one open cell a seed, and prints a table of what the world shows after the arm let go.
"""

from __future__ import annotations

import argparse
import json
import math
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
from engine.messages.pose_algebra import angle_between_rad
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.record.skill_port import BusPort
from engine.runtime.run import Run
from engine.skills.hexapods import ReadHexapod

BEHAVIORS = Path(__file__).resolve().parents[1] / "behaviors"
JIGS = ("north_jig", "south_jig")
POSES = ("high", "tilted", "turned", "aside", "level")


@dataclass(frozen=True, kw_only=True)
class Approach:
    """One pose of one hexapod: how the behavior ended, and how far the platform is from the pose then."""

    realism: str
    by: str
    seed: int
    jig: str
    pose: str
    outcome: str
    error_mm: float
    error_deg: float


def cell_with(realism: RealismName) -> Cell:
    """Return the cell with another realism of its arm."""
    cell = load_cell(BEHAVIORS / "cells" / "hexapods.yaml")
    world = cell.document.world
    assert world is not None
    document = replace(cell.document, world=replace(world, realism=realism))
    return Cell(document=document, file=cell.file, source=cell.source, modules=cell.modules, carried=cell.carried)


async def approaches(
    realism: RealismName, by: str, seed: int, folder: Path, *, done_one: Callable[[Approach], None]
) -> list[Approach]:
    """Move both hexapods to all of their poses; `done_one` is called with each."""
    done: list[Approach] = []
    plan = new_plan(load_behavior(BEHAVIORS / "hexapods" / "reconfigure.yaml"), load_states())
    async with OpenCell(cell_with(realism), seed=seed, store_path=str(folder / "store.db")) as cell:
        for jig, pose in ((jig, pose) for pose in POSES for jig in JIGS):
            run = Run(
                plan,
                skills=BusPort(cell.bus),
                run=f"{jig}-{pose}",
                bus=cell.bus,
                parameters={"jig": jig, "pose": pose, "measured_by": by},
                inputs={},
                seed=seed,
                supervision=None,
                journal=NullJournal().begin(jig, behavior="", document="", started_unix_s=0.0),
            )
            outcome = (await run.execute()).outcome
            at = await cell.bus.call(ReadHexapod(pose=pose), to=f"{jig}/legs")
            done.append(
                Approach(
                    realism=realism,
                    by=by,
                    seed=seed,
                    jig=jig,
                    pose=pose,
                    outcome=str(outcome),
                    error_mm=1e3 * math.dist(at.platform.xyz, at.target.xyz),
                    error_deg=math.degrees(angle_between_rad(at.platform.xyzw, at.target.xyzw)),
                )
            )
            done_one(done[-1])
            if outcome in (None, "failed", "loose"):
                break  # the arm still holds it
    return done


def write(file: Path | None, approach: Approach) -> None:
    """Append an approach to a file, if there is one."""
    if file is not None:
        with file.open("a", encoding="utf-8") as lines:
            lines.write(json.dumps(asdict(approach)) + "\n")


def row(done: list[Approach]) -> str:
    """Return the row of a table: how many of them are at their pose, with median, 95th percentile and maximum."""
    good = sum(each.error_mm <= 0.5 and each.error_deg <= 0.2 for each in done)
    mm, degrees = np.array([each.error_mm for each in done]), np.array([each.error_deg for each in done])
    columns = (f"{np.median(each):.2f} / {np.quantile(each, 0.95):.2f} / {each.max():.2f}" for each in (mm, degrees))
    return f"| {done[0].realism} | {done[0].by} | {len(done)} | {good} | {' | '.join(columns)} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20, help="seeds with errors of the arm (without, all are alike)")
    parser.add_argument("--by", choices=("arm", "cell"), nargs="+", default=["cell", "arm"], help="what measures")
    parser.add_argument("--realism", choices=("ideal", "typical", "poor"), nargs="+", default=["ideal", "typical"])
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every approach to FILE, one a line")
    options = parser.parse_args()
    print("| errors of the arm | measured by | moves | within 0.5 mm, 0.2° | mm: median / 95 % / max | degrees |")
    print("|---|---|---|---|---|---|")
    for realism in options.realism:
        for by in options.by:
            done: list[Approach] = []
            for seed in range(1, 2 if realism == "ideal" else options.seeds + 1):
                with tempfile.TemporaryDirectory() as folder:
                    done += run_virtual(
                        approaches(realism, by, seed, Path(folder), done_one=partial(write, options.json))
                    )
            print(row(done), flush=True)


if __name__ == "__main__":
    main()
