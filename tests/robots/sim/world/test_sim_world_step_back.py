"""A pick in the simulated cell is stepped back: the part lies where it lay, and the arm stands where it stood."""

from __future__ import annotations

import asyncio
from pathlib import Path

import numpy as np

from engine.clock import run_virtual
from engine.document import parse_behavior
from engine.event import Event, NodeEntered, NodeExited, PauseConfirmed, RunSteppedBack
from engine.journal import Journal
from engine.project.cell_runner import CellRunner
from engine.project.run_request import RunRequest
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from robots.port import Array
from tests.robots.sim.demo_cell import joint_state, opened_cell, part_height_m

PICKING = """
flexcell: 1
name: picking
outcomes: [lifted, failed]
success: [lifted]
root:
  machine:
    initial: above
    states:
      above:
        state: motion.MovePose
        with: {robot: left, target: {xyz: [-0.11, 0.28, 0.178], xyzw: [1, 0, 0, 0]}, speed: 0.5}
        transitions: {reached: down, failed: failed}
      down:
        state: motion.MoveLinear
        with: {robot: left, target: {xyz: [-0.11, 0.28, 0.028], xyzw: [1, 0, 0, 0]}, duration_s: 1.0}
        transitions: {reached: grasp, failed: failed}
      grasp:
        state: gripper.Grasp
        with: {gripper: left, width_m: 0.03, force_n: 30}
        transitions: {held: lift, missed: failed, failed: failed}
      lift:
        state: motion.MoveLinear
        with: {robot: left, target: {xyz: [-0.11, 0.28, 0.178], xyzw: [1, 0, 0, 0]}, speed_m_s: 0.2}
        transitions: {reached: lifted, failed: failed}
"""


async def at_rest(rests: asyncio.Event, run: Run) -> None:
    """Wait until the run has come to rest after an order."""
    await rests.wait()
    rests.clear()
    await run.control.settled()


def test_a_pick_is_taken_back_from_the_middle_of_the_lift_and_done_again(tmp_path: Path) -> None:
    async def main() -> tuple[RunResult, list[Event], list[tuple[str, float, Array]], float]:
        events: list[Event] = []
        stood: list[tuple[str, float, Array]] = []
        lifting, rests = asyncio.Event(), asyncio.Event()

        def note(event: Event) -> None:
            events.append(event)
            if isinstance(event, NodeEntered) and event.path == "root/lift":
                lifting.set()
            if isinstance(event, PauseConfirmed):
                rests.set()

        with Journal.open(tmp_path, inline=True) as journal:
            async with opened_cell(tmp_path, seed=3) as cell:
                plan = new_plan(parse_behavior(PICKING, file="picking.yaml"), load_states())
                run = (await CellRunner(cell, journal).start(RunRequest(plan=plan))).run
                run.watch(note)
                before = np.array(joint_state(cell.bus).position_rad)
                stood.append(("begin", part_height_m(cell.bus), before))
                doing = asyncio.create_task(run.execute())
                await lifting.wait()
                await cell.bus.clock.sleep(0.4)
                run.control.pause()
                await at_rest(rests, run)
                stood.append(("lifting", part_height_m(cell.bus), np.array(joint_state(cell.bus).position_rad)))
                for _ in range(4):
                    (path,) = await run.step_back()
                    await at_rest(rests, run)
                    stood.append((path, part_height_m(cell.bus), np.array(joint_state(cell.bus).position_rad)))
                run.control.resume()
                result = await doing
                return result, events, stood, part_height_m(cell.bus)

    result, events, stood, height_m = run_virtual(main())
    assert [place for place, _, _ in stood] == [
        "begin", "lifting", "root/lift", "root/grasp", "root/down", "root/above",
    ]  # fmt: skip
    _, lying_m, home = stood[0]
    assert stood[1][1] > lying_m + 0.01
    for place, part_m, _ in stood[2:]:
        assert abs(part_m - lying_m) < 0.003, place
    assert np.abs(stood[-1][2] - home).max() < 0.005
    assert all(event.cause is None for event in events if isinstance(event, RunSteppedBack))
    assert (result.outcome, result.success) == ("lifted", True)
    assert height_m > lying_m + 0.1
    assert sum(isinstance(event, NodeExited) and event.path == "root/grasp" for event in events) == 2
