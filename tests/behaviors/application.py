"""Runs a behavior that ships with flexcell in its simulated cell, in lockstep, and keeps what was seen on the way."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import load_behavior, load_cell
from engine.document.cell import Cell
from engine.document.faults import Faults
from engine.event import Event, NodeExited
from engine.faults import FaultPort
from engine.journal import NullJournal
from engine.messages import JointState, PartPoses, Pose
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.record.skill_port import BusPort
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.runtime.run_result import RunResult

BEHAVIORS = Path(__file__).parents[2] / "behaviors"
SAMPLE_S = 0.05

Meanwhile = Callable[[Run, OpenCell], Coroutine[Any, Any, None]]


@dataclass(frozen=True, kw_only=True)
class Seen:
    """Where everything was at one instant of a run."""

    time_s: float
    joints: JointState
    parts: PartPoses


@dataclass(kw_only=True)
class Application:
    """One run of a behavior, below `behaviors/`, in a cell; `seen` every `SAMPLE_S`, the last one after its end."""

    behavior: str
    cell: Cell
    seed: int | None = None
    parameters: dict[str, object] = field(default_factory=dict[str, object])
    faults: Faults | None = None
    meanwhile: Meanwhile | None = None
    supervision: RunOptions | None = None
    log: list[Event] = field(default_factory=list[Event])
    seen: list[Seen] = field(default_factory=list[Seen])

    def run(self, folder: Path) -> RunResult:
        """Run it to its end; its store lies in `folder`."""
        return run_virtual(self._run(folder))

    @property
    def left(self) -> list[str]:
        """The paths that were left with their outcomes, `root/pick/grasp missed`, in order."""
        return [f"{event.path} {event.outcome}" for event in self.log if isinstance(event, NodeExited)]

    def last(self, part: str) -> Pose:
        """Where a part was after the end."""
        return self.seen[-1].parts.poses[part]

    @property
    def greatest_last_speed_rad_s(self) -> float:
        """The greatest speed of a joint after the end."""
        return max(abs(speed) for speed in self.seen[-1].joints.velocity_rad_s)

    async def _run(self, folder: Path) -> RunResult:
        plan = new_plan(load_behavior(BEHAVIORS / self.behavior), load_states())
        async with OpenCell(self.cell, seed=self.seed, store_path=str(folder / "store.db")) as cell:
            run = Run(
                plan,
                skills=self._port(cell),
                run="application",
                bus=cell.bus,
                parameters=self.parameters,
                inputs={},
                seed=self.seed or 0,
                supervision=self.supervision,
                journal=NullJournal().begin("application", behavior="", document="", started_unix_s=0.0),
            )
            run.watch(self.log.append)
            beside = [self._watch(cell)] + ([self.meanwhile(run, cell)] if self.meanwhile is not None else [])
            tasks = [asyncio.ensure_future(each) for each in beside]
            try:
                result = await run.execute()
                await cell.bus.clock.sleep(SAMPLE_S)
                self._look(cell)
            finally:
                for task in tasks:
                    task.cancel()
                ends = await asyncio.gather(*tasks, return_exceptions=True)
            for end in ends:
                if isinstance(end, Exception):
                    raise end
            return result

    def _port(self, cell: OpenCell) -> FaultPort | None:
        if self.faults is None:
            return None
        return FaultPort(BusPort(cell.bus), self.faults, clock=cell.bus.clock, seed=self.seed or 0)

    async def _watch(self, cell: OpenCell) -> None:
        while True:
            self._look(cell)
            await cell.bus.clock.sleep(SAMPLE_S)

    def _look(self, cell: OpenCell) -> None:
        joints = cell.bus.topic("arm/joint_state", JointState).latest
        parts = cell.bus.topic("cell/parts", PartPoses).latest
        if joints is not None and parts is not None:
            self.seen.append(Seen(time_s=cell.bus.clock.now_s(), joints=joints, parts=parts))


def shipped_cell(name: str) -> Cell:
    """The cell of that name as it is shipped."""
    return load_cell(BEHAVIORS / "cells" / f"{name}.yaml")


def changed_cell(
    name: str, folder: Path, *, cell: Callable[[str], str] = str, entries: Callable[[str], str] = str
) -> Cell:
    """The cell with the text of its document, or of its entries, changed; both are written to `folder`."""
    for kind, change in (("cells", cell), ("entries", entries)):
        (folder / kind).mkdir()
        text = (BEHAVIORS / kind / f"{name}.yaml").read_text(encoding="utf-8")
        here = text.replace("../../robots", str(BEHAVIORS.parent / "robots"))
        changed = change(here)
        assert change is str or changed != here, "the change changes nothing"
        (folder / kind / f"{name}.yaml").write_text(changed, encoding="utf-8")
    return load_cell(folder / "cells" / f"{name}.yaml")


def without_parts(text: str) -> str:
    """Take the parts away from a cell document."""
    return re.sub(r"(?s)\nparts:.*", "\nparts: {}\n", text)


def causes(result: RunResult) -> str:
    """The cause chain as one text."""
    return "; ".join(link.message for link in result.cause.chain()) if result.cause else ""
