"""Which set points jump: `python -P -m benchmarks.set_points [--orders N] [--seed N] [--results FILE]`; exit code 1
where one does.

Random orders to the left arm of the demo cell, in virtual time: motions of every kind, each cancelled, held and
resumed, replaced by the next one, stopped, slowed down, pushed at, or given another load or tool at a random time. The
watch of the control loop compares every set point with the limits of the arm. The table counts its reports by the
generators before and after, with the largest share of the limit of each quantity. Each cell of 50 orders is one line of
the results file; lines of the same seed that are there already are not executed again.
"""

from __future__ import annotations

import argparse
import asyncio
import logging
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from engine.bus import GoalHandle, SkillBus
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.errors import FlexcellError
from engine.messages import JointState, Pose
from engine.robot import Robot
from engine.skill import Action
from engine.skills.arm_control import (
    RecoverFromError,
    SetCollisionBehavior,
    SetController,
    SetEndEffectorFrame,
    SetLoad,
    SetSpeedOverride,
)
from engine.skills.contact import MoveUntilContact
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.jogging import JogCommand
from engine.skills.motion import CartLinTask
from engine.skills.planning import MotionTarget, MoveFree
from engine.skills.simulated_world import PushBody
from robots.control.motion_event import SetPointJumped
from robots.port import Array
from tests.robots.arm.every_skill import MAKERS, near_home, some
from tests.robots.panda_arm import panda_kinematics

ARM = "left"
ROOT = Path(__file__).parents[1]
CELL = ROOT / "behaviors" / "cells" / "dual_panda.yaml"
# The parts of a cell are pushed about: so many orders later it is a new one.
_ORDERS_OF_A_CELL = 50


class CellOrders(msgspec.Struct, frozen=True, kw_only=True):
    """The orders to one cell, and what jumped."""

    seed: int
    first: int
    orders: int
    goals: dict[str, int]
    jumps: list[SetPointJumped]
    duration_s: float


class JumpCollector(logging.Handler):
    """Collects what the watches of this process report."""

    def __init__(self) -> None:
        super().__init__()
        self.jumps: list[SetPointJumped] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Take a report."""
        jump = getattr(record, "jump", None)
        if isinstance(jump, SetPointJumped):
            self.jumps.append(jump)


class RandomOrders:
    """Gives orders to one arm."""

    def __init__(self, bus: SkillBus, arm: Robot, chance: random.Random) -> None:
        self._bus = bus
        self._arm = arm
        self._chance = chance
        self._goal: GoalHandle[Any, Any] | None = None
        self._asked: set[asyncio.Task[Any]] = set()
        self.goals: Counter[str] = Counter()

    async def order(self) -> None:
        """Start a motion, let some time pass, and disturb it."""
        chance = self._chance
        await self._call(RecoverFromError())
        goal = chance.choice((*MAKERS, _move_free, _place, _press_on_table))(self._joints(), chance)
        self.goals[goal.skill_name()] += 1
        self._goal = self._bus.send_goal(goal, to=ARM)
        await self._pass(1.0)
        acts: tuple[Callable[[], Awaitable[None]], ...] = (
            self._replace, self._cancel, self._hold_and_resume, self._stop, self._set, self._push, self._finish,
            self._stream,
        )  # fmt: skip
        await chance.choice(acts)()

    async def end(self) -> None:
        """Bring the arm to rest."""
        await self._stop()
        for task in self._asked:
            await task

    async def _pass(self, longest_s: float) -> None:
        await self._bus.clock.sleep(self._chance.uniform(0.0, longest_s))

    async def _replace(self) -> None:
        """The next motion replaces this one."""

    async def _finish(self) -> None:
        if self._goal is not None:
            try:
                async with asyncio.timeout(4.0):
                    await self._goal.result()
            except TimeoutError:
                self._goal.cancel()

    async def _cancel(self) -> None:
        if self._goal is not None:
            self._goal.cancel()
        await self._pass(0.2)

    async def _hold_and_resume(self) -> None:
        for _ in range(self._chance.randrange(1, 4)):
            if self._goal is not None:
                self._ask(self._goal.hold())
                await self._pass(0.3)
                self._ask(self._goal.resume())
                await self._pass(0.3)

    def _ask(self, request: Any) -> None:
        task = asyncio.ensure_future(request)
        self._asked.add(task)
        task.add_done_callback(self._asked.discard)

    async def _stop(self) -> None:
        await self._arm.stop()

    async def _set(self) -> None:
        chance = self._chance
        requests: tuple[Any, ...] = (
            SetSpeedOverride(share=chance.choice((0.05, 0.3, 1.0, 1.0))),
            SetController(controller=chance.choice(("joint_impedance", "cartesian_impedance"))),
            SetEndEffectorFrame(xyz_m=(0.0, 0.0, chance.choice((0.0, 0.1)))),
            SetLoad(mass_kg=chance.choice((0.0, 0.5))),
            SetCollisionBehavior(force_n=chance.choice((None, 25.0))),
        )
        await self._call(chance.choice(requests))
        await self._pass(0.5)

    async def _push(self) -> None:
        force_n = some(self._chance, self._chance.choice((10.0, 80.0)), 3)
        push = PushBody(body=f"{ARM}/panda_hand", force_n=(force_n[0], force_n[1], force_n[2]), duration_s=0.15)
        await self._bus.call(push, to="cell")
        await self._pass(1.0)

    async def _stream(self) -> None:
        chance = self._chance
        if self._goal is not None:
            self._goal.cancel()
        await self._pass(0.3)
        await self._call(SwitchDirectControl(on=True, watchdog_s=0.2))
        for _ in range(chance.randrange(30)):
            self._bus.topic(f"{ARM}/direct_joints", JointCommand).publish(JointCommand(position_rad=near_home(chance)))
            self._bus.topic(f"{ARM}/jog", JogCommand).publish(JogCommand(velocity=some(chance, 0.2, 6)))
            await self._pass(0.1)
        await self._call(SwitchDirectControl(on=False))

    async def _call(self, request: Any) -> None:
        try:
            await self._bus.call(request, to=ARM)
        except FlexcellError:
            # Some are refused while the arm moves.
            return

    def _joints(self) -> Array:
        state = self._bus.topic(f"{ARM}/joint_state", JointState).latest
        assert state is not None
        return np.array(state.position_rad)


def _move_free(_: Array, chance: random.Random) -> Action[Any, Any]:
    return MoveFree(target=MotionTarget(joints=near_home(chance)))


def _place(now: Array, chance: random.Random) -> Action[Any, Any]:
    """A line that ends in the table now and then."""
    x, y, z = panda_kinematics().tool_pose(now).xyz.tolist()
    down = (1.0, 0.0, 0.0, 0.0)
    at = (x + chance.uniform(-0.05, 0.05), y, z - chance.uniform(0.05, 0.7))
    return CartLinTask(pose=Pose(xyz=at, xyzw=down), duration_s=chance.uniform(1.0, 2.0))


def _press_on_table(_: Array, chance: random.Random) -> Action[Any, Any]:
    return MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.6, speed_m_s=chance.uniform(0.1, 0.4))


async def _orders(count: int, chance: random.Random, folder: Path, goals: Counter[str]) -> None:
    async with OpenCell(load_cell(CELL), seed=chance.randrange(1000), store_path=str(folder / "store.db")) as cell:
        arm = cell.robots[ARM]
        orders = RandomOrders(cell.bus, arm, chance)
        for _ in range(count):
            await orders.order()
        await orders.end()
        goals.update(orders.goals)


def order_cell(seed: int, first: int, count: int) -> CellOrders:
    """Give orders to a new cell."""
    collector, goals = JumpCollector(), Counter[str]()
    log = logging.getLogger("flexcell.set_points")
    log.addHandler(collector)
    started_s = time.monotonic()
    try:
        with tempfile.TemporaryDirectory() as folder:
            run_virtual(_orders(count, random.Random(f"{seed} {first}"), Path(folder), goals))
    finally:
        log.removeHandler(collector)
    duration_s = time.monotonic() - started_s
    return CellOrders(
        seed=seed, first=first, orders=count, goals=dict(goals), jumps=collector.jumps, duration_s=duration_s
    )


def saved_cells(results: Path) -> dict[tuple[int, int, int], CellOrders]:
    """Return the lines of a results file; a last line that was cut off is left out."""
    if not results.exists():
        return {}
    lines = [line for line in results.read_bytes().splitlines(keepends=True) if line.endswith(b"\n")]
    cells = [msgspec.json.decode(line, type=CellOrders) for line in lines]
    return {(cell.seed, cell.first, cell.orders): cell for cell in cells}


def order_cells(orders: int, seed: int, results: Path | None) -> list[CellOrders]:
    """Give the orders that are not saved yet, and return all."""
    saved = saved_cells(results) if results is not None else {}
    cells: list[CellOrders] = []
    for first in range(0, orders, _ORDERS_OF_A_CELL):
        count = min(_ORDERS_OF_A_CELL, orders - first)
        cell = saved.get((seed, first, count))
        if cell is None:
            cell = order_cell(seed, first, count)
            if results is not None:
                _append(results, cell)
        cells.append(cell)
        jumps = sum(len(one.jumps) for one in cells)
        print(f"{first + count} orders, {jumps} jumps", file=sys.stderr, flush=True)
    return cells


def _append(results: Path, cell: CellOrders) -> None:
    with results.open("ab+") as file:
        file.seek(0)
        content = file.read()
        # A line that was cut off must not swallow the next one.
        file.truncate(content.rfind(b"\n") + 1)
        file.write(msgspec.json.encode(cell) + b"\n")


def main() -> int:
    """Give the orders and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--orders", type=int, default=200, help="number of orders (default 200)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--results", type=Path, help="file of JSON lines in which results are kept and looked up")
    options = parser.parse_args()
    cells = order_cells(options.orders, options.seed, options.results)
    goals: Counter[str] = Counter()
    for cell in cells:
        goals.update(cell.goals)
    jumps = [jump for cell in cells for jump in cell.jumps]
    print(", ".join(f"{name} {count}" for name, count in sorted(goals.items())))
    _print_table(jumps)
    print(f"{len(jumps)} jumps in {options.orders} orders, {sum(cell.duration_s for cell in cells):.0f} s")
    return 1 if jumps else 0


def _print_table(jumps: list[SetPointJumped]) -> None:
    rows: dict[tuple[str, str, str], list[SetPointJumped]] = {}
    for jump in jumps:
        rows.setdefault((jump.before, jump.generator, jump.quantity), []).append(jump)
    print(f"{'before':<28}{'generator':<28}{'quantity':<14}{'jumps':>6}{'x limit':>9}")
    for (before, generator, quantity), found in sorted(rows.items()):
        largest = max(found, key=lambda jump: jump.ratio)
        print(f"{before:<28}{generator:<28}{quantity:<14}{len(found):>6}{largest.ratio:>9.2f}")


if __name__ == "__main__":
    sys.exit(main())
