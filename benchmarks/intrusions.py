"""Measures intrusions: `python -P benchmarks/intrusions.py [--runs N] [--control N] [--seed S] [--json FILE]`.

The arm of one of two people gets into the path of an arm that moves between two places, at a random moment, at or
near a random place of the path that is left, at 0.25 to 1.2 m/s, for 0.3 to 3 s or for ever. Physics runs in virtual
time, cameras see what there is, and MuJoCo counts what the people touch. The control group goes the same paths with
the same intrusions and does not look out: it must show contacts, or the others mean nothing.

With `--separation` people come from 1.3 m away, where cameras see them, and all intrusions are also carried out with
speed and separation monitoring (`monitored`), by motions that look out and motions that do not in turns.

Every drawn hand that gets into the path is executed and counted, by what could avoid a contact (`Avoidability`):
braking, only having been slower (ISO 13855: the person comes within the minimum distance), or nothing the arm does.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import get_args

import msgspec
import numpy as np

from benchmarks.comparison import machine
from benchmarks.intrusion_drawing import Avoidability, Intrusion, IntrusionDrawer, UndisturbedMotion
from benchmarks.intrusion_layout import (
    with_people_from_afar,
    with_people_on_both_sides,
    with_separation_monitoring,
)
from benchmarks.intrusion_run import IntrusionResult, intruded_cell
from engine.clock import run_virtual
from engine.document.cell import Cell, load_cell
from engine.messages import Pose
from engine.skills.planning import MotionTarget
from robots.scene.scene_builder import build_scene
from robots.sim.physics.cell_model import build_cell

CELL = Path(__file__).resolve().parent / "cells" / "irb4600_near.yaml"
REACTION_S = 0.25
"""Two images at 15 Hz, what is made of them, and one check of the path."""

_DOWN = (0.0, 1.0, 0.0, 0.0)
_ENDS = (Pose(xyz=(1.1, -0.7, 1.0), xyzw=_DOWN), Pose(xyz=(1.1, 0.7, 1.0), xyzw=_DOWN))
_TRIAL_S = 600.0
_PER_CELL = 50

MONITORED = "monitored"
"""The group with speed and separation monitoring, in which MoveFree and JointTrapVel take turns."""

Numbered = tuple[int, Intrusion]


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One intrusion, by its number in the drawing, and how the motion ended; `cpu_s` is what it took of the machine."""

    group: str
    number: int
    intrusion: Intrusion
    ended: IntrusionResult
    cpu_s: float


@dataclass(frozen=True, kw_only=True)
class UndisturbedMotions:
    """The motion there and that back, undisturbed, and how long the arm takes to stop."""

    there: UndisturbedMotion
    back: UndisturbedMotion
    stopping_s: float

    def of(self, number: int) -> UndisturbedMotion:
        """Return the motion of an intrusion: there and back in turns."""
        return self.back if number % 2 else self.there


async def _undisturbed(document: Cell, speed: float) -> UndisturbedMotions:
    async with intruded_cell(document, speed=speed) as cell:
        left = await cell.free(MotionTarget(pose=_ENDS[1]))
        right = await cell.free(MotionTarget(pose=_ENDS[0]))
        there = await cell.recorded(left)
        back = await cell.recorded(right)
        return UndisturbedMotions(there=there, back=back, stopping_s=await cell.stopping_s(there))


async def _trials(
    document: Cell,
    motions: UndisturbedMotions,
    intrusions: Iterable[Numbered],
    *,
    group: str,
    speed: float,
    log: Path | None,
) -> list[Trial]:
    """Carry out intrusions in a cell until one ends badly."""
    done: list[Trial] = []
    async with intruded_cell(document, speed=speed) as cell:
        for number, intrusion in intrusions:
            undisturbed = motions.of(number)
            await cell.free(MotionTarget(joints=undisturbed.start))
            started_s = time.process_time()
            async with asyncio.timeout(_TRIAL_S):
                ended = await cell.intruded(undisturbed, intrusion, adapts=_adapts(group, number))
            trial = Trial(
                group=group,
                number=number,
                intrusion=intrusion,
                ended=ended,
                cpu_s=time.process_time() - started_s,
            )
            done.append(trial)
            print(_line(trial), flush=True)
            if log is not None:
                with log.open("ab") as file:
                    file.write(msgspec.json.encode(trial) + b"\n")
            if ended.end in ("failed", "stuck") or ended.contacts:
                break
    return done


def _adapts(group: str, number: int) -> bool:
    """Return whether the motion is a MoveFree: all, none, or with separation monitoring both in turns."""
    return number // 2 % 2 == 0 if group == MONITORED else group == "MoveFree"


def _group(
    document: Cell,
    motions: UndisturbedMotions,
    draw: Callable[[int], Intrusion],
    numbers: Sequence[int],
    *,
    group: str,
    speed: float,
    log: Path | None = None,
) -> list[Trial]:
    """Carry out all that the log does not have; after one that ended badly the next begins in a new cell."""
    done = [trial for trial in _logged(log) if trial.group == group]
    known = {trial.number for trial in done}
    left = [number for number in numbers if number not in known]
    while left:
        some = ((number, draw(number)) for number in left[:_PER_CELL])
        carried_out = run_virtual(_trials(document, motions, some, group=group, speed=speed, log=log))
        left = left[len(carried_out) :]
        done += carried_out
    return sorted(done, key=lambda trial: trial.number)


def _logged(log: Path | None) -> list[Trial]:
    if log is None or not log.exists():
        return []
    return [msgspec.json.decode(line, type=Trial) for line in log.read_bytes().splitlines()]


def _line(trial: Trial) -> str:
    ended, intrusion = trial.ended, trial.intrusion
    stay = "for ever" if intrusion.stay_s is None else f"{intrusion.stay_s:.1f} s"
    contacts = (
        f"{ended.contacts} contacts ({ended.in_motion} in motion, at {ended.speed_m_s:.2f} m/s, "
        f"{ended.greatest_force_n:.0f} N)"
    )
    text = (
        f"{trial.group} {trial.number:3}: {ended.end} after {ended.duration_s:.1f} s, {contacts}, {ended.stops} stops, "
        f"{ended.replans} replans; hand at {intrusion.after_s:.2f} s to {intrusion.near}, "
        f"{intrusion.speed_m_s:.2f} m/s, {stay}, avoidable by {intrusion.avoidable_by}; {trial.cpu_s:.1f} s CPU"
    )
    return f"{text}; {ended.reason}" if ended.reason else text


def _table(groups: Sequence[tuple[str, Sequence[Trial]]]) -> str:
    lines = [
        (
            "| group | avoidable by | intrusions | with a contact | by an arm in motion | at m/s, p50 | at m/s, worst "
            "| N, worst | reached | waiting while blocked | failed | stuck | stops | other paths | waited p50 s |"
        ),
        "|---|---|" + "---:|" * 13,
    ]
    for name, trials in groups:
        for avoidable_by in get_args(Avoidability):
            ended = [trial.ended for trial in trials if trial.intrusion.avoidable_by == avoidable_by]
            if ended:
                lines.append(f"| {name} | {avoidable_by} {_row(ended)}")
    return "\n".join(lines)


def _row(ended: Sequence[IntrusionResult]) -> str:
    ends = {end: sum(one.end == end for one in ended) for end in ("reached", "waiting", "failed", "stuck")}
    speeds = [one.speed_m_s for one in ended if one.in_motion] or [0.0]
    waited = float(np.median([one.waited_s for one in ended]))
    return (
        f"| {len(ended)} | {sum(one.contacts > 0 for one in ended)} | {sum(one.in_motion > 0 for one in ended)} "
        f"| {float(np.median(speeds)):.2f} | {max(speeds):.2f} | {max(one.greatest_force_n for one in ended):.0f} "
        f"| {ends['reached']} | {ends['waiting']} | {ends['failed']} | {ends['stuck']} "
        f"| {sum(one.stops for one in ended)} | {sum(one.replans for one in ended)} | {waited:.2f} |"
    )


def main() -> None:
    """Draw, run, print, and write the JSON file if asked to."""
    parser = argparse.ArgumentParser(description="Measures what happens when a person reaches into an arm's path.")
    parser.add_argument("--runs", type=int, default=200, help="intrusions into motions that look out (default 200)")
    parser.add_argument("--control", type=int, default=20, help="of these, also into motions that do not (default 20)")
    parser.add_argument("--seed", type=int, default=0, help="of the drawing (default 0)")
    parser.add_argument("--only", type=int, nargs="*", help="carry out these numbers of the drawing only")
    parser.add_argument("--avoidable-by", choices=get_args(Avoidability), help="carry out these of the drawing only")
    parser.add_argument("--speed", type=float, default=0.3, help="share of the joint speed limits (default 0.3)")
    parser.add_argument("--cell", type=Path, default=CELL, help="a cell of one arm with people on one side")
    parser.add_argument(
        "--separation",
        action="store_true",
        help="people come from afar; run the intrusions with speed and separation monitoring too",
    )
    parser.add_argument("--log", type=Path, help="append each trial to this file, and carry out only what it lacks")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every trial to FILE")
    options = parser.parse_args()
    document = with_people_on_both_sides(load_cell(options.cell))
    if options.separation:
        document = with_people_from_afar(document)
    motions = run_virtual(_undisturbed(document, options.speed))
    drawer = IntrusionDrawer(build_cell(build_scene(document.document)), stopping_s=REACTION_S + motions.stopping_s)

    @cache
    def draw(number: int) -> Intrusion:
        """Return the intrusion of a number, whatever else is drawn."""
        return drawer.draw(motions.of(number), np.random.default_rng((options.seed, number)))

    numbers = options.only or list(range(options.runs))
    if options.avoidable_by:
        numbers = [number for number in numbers if draw(number).avoidable_by == options.avoidable_by]
    print(
        f"{document.name}: there {motions.there.duration_s:.2f} s, back {motions.back.duration_s:.2f} s; "
        f"the arm stops within {motions.stopping_s:.2f} s, reacts within {REACTION_S:.2f} s (taken). {machine()}.\n",
        flush=True,
    )
    speed, log = options.speed, options.log
    groups = [("JointTrapVel", document, numbers[: options.control]), ("MoveFree", document, numbers)]
    if options.separation:
        groups[1] = ("MoveFree", document, numbers[: options.control])
        groups.append((MONITORED, with_separation_monitoring(document), numbers))
    trials = {
        group: _group(cell, motions, draw, some, group=group, speed=speed, log=log) for group, cell, some in groups
    }
    if drawer.drawn:
        print(f"\nOf {drawer.drawn} places drawn that are in reach, {drawer.beside} are beside the path.")
    print(f"\n{_table(tuple(trials.items()))}")
    if options.json is not None:
        everything = {"machine": machine(), "trials": [asdict(trial) for group in trials.values() for trial in group]}
        options.json.write_text(json.dumps(everything, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
