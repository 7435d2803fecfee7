"""Intrusions are drawn into the path, classed by what avoids a contact, and a motion that does not look out is hit."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.intrusion_drawing import STEP_S, Avoidability, Intrusion, IntrusionDrawer, UndisturbedMotion
from benchmarks.intrusion_run import IntrusionResult, intruded_cell
from benchmarks.intrusions import CELL
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.skills.people import Reach
from engine.skills.planning import MotionTarget
from robots.scene.scene_builder import build_scene
from robots.sim.commands.world_commands import MovePersonHand
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import CellModel, build_cell

DOCUMENT = load_cell(CELL)
RIGHT = (-0.567, 0.18, 0.13, 0.0, 1.26, -0.567)
LEFT = (0.567, 0.18, 0.13, 0.0, 1.26, 0.567)
STOPPING_S = 0.5


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(build_scene(DOCUMENT.document))


def _motion(duration_s: float = 3.0) -> UndisturbedMotion:
    s = np.linspace(0.0, 1.0, round(duration_s / STEP_S) + 1)[:, None]
    share = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    return UndisturbedMotion(
        start=RIGHT, goal=LEFT, joints=np.array(RIGHT) + share * (np.array(LEFT) - np.array(RIGHT))
    )


def _drawn(cell: CellModel, *, count: int, seed: int = 0) -> list[Intrusion]:
    drawer, random = IntrusionDrawer(cell, stopping_s=STOPPING_S), np.random.default_rng(seed)
    return [drawer.draw(_motion(), random) for _ in range(count)]


def test_a_seed_draws_the_same_again_and_another_seed_others(cell: CellModel) -> None:
    first = _drawn(cell, count=2)
    assert _drawn(cell, count=2) == first
    assert _drawn(cell, count=2, seed=1) != first


def test_drawn_hands_are_classed_by_where_the_arm_can_have_stopped(cell: CellModel) -> None:
    """In the physics: each is not touched where the arm has stopped in time for its class."""
    path, seen = _motion(), set[Avoidability]()
    for intrusion in _drawn(cell, count=8):
        assert intrusion.after_s < intrusion.noticeable_s
        assert 0.25 <= intrusion.speed_m_s <= 1.2
        if intrusion.avoidable_by in seen or intrusion.avoidable_by == "nothing":
            continue
        assert intrusion.noticeable_s < path.duration_s
        seen.add(intrusion.avoidable_by)
        stopped_s = intrusion.noticeable_s + (STOPPING_S if intrusion.avoidable_by == "stopping" else 0.0)
        assert not _touched(cell, intrusion, path, until_row=int(stopped_s / STEP_S))
    assert seen == {"stopping", "slower"}


def _touched(cell: CellModel, intrusion: Intrusion, way: UndisturbedMotion, *, until_row: int) -> bool:
    """Return whether the reach touches an arm that is carried along a way and left there."""
    simulation = Simulation(cell)
    positions, (arm,) = simulation._qpos, cell.arms  # pyright: ignore[reportPrivateUsage]
    reach = MovePersonHand(reach=Reach(person=intrusion.person, hand_m=intrusion.hand_m, speed_m_s=intrusion.speed_m_s))
    sent = round(intrusion.after_s / STEP_S)
    steps = round(STEP_S / simulation.step_s)
    last = min(until_row, len(way.joints) - 1)
    for row in range(sent, last + round(2.0 / STEP_S)):
        if row == sent:
            simulation.apply(reach)
        for _ in range(steps):
            positions[arm.qpos] = way.joints[min(row, last)]
            simulation.step()
    values = simulation.layout.new_array()
    simulation.write_snapshot(values)
    return SimSnapshot(simulation.layout, values).person(intrusion.person).count.contacts > 0


def test_the_control_group_drives_into_the_hand() -> None:
    """Over the middle between the pedestals, where the magnet passes."""
    in_the_way = Intrusion(
        person="visitor",
        after_s=0.1,
        hand_m=(1.25, 0.25, 1.12),
        speed_m_s=1.2,
        stay_s=None,
        near="arm/magnet_base",
        noticeable_s=0.6,
        avoidable_by="stopping",
    )

    async def main() -> IntrusionResult:
        async with intruded_cell(DOCUMENT, speed=0.3) as cell:
            await cell.free(MotionTarget(joints=RIGHT))
            return await cell.intruded(_motion(), in_the_way, adapts=False)

    ended = run_virtual(main())
    assert ended.contacts > 0
    assert ended.in_motion == ended.contacts
    assert 0.1 < ended.speed_m_s < 2.5
    assert ended.greatest_force_n > 0.0
    assert any(own.startswith("visitor/") and other.startswith("arm/") for own, other in ended.pairs)
