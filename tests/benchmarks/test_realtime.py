"""The benchmarks of the world's process and of virtual time measure what they say; the figures are not looked at."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.busy_cell import BEHAVIOR
from benchmarks.process_cpu import cpu_s, descendants
from benchmarks.realtime import Row, table
from benchmarks.sim import filled
from benchmarks.step_cost import step_cost
from benchmarks.swinging_arms import CELL, swings
from benchmarks.timing_jitter import Punctuality, merged, watch
from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.cli.inputs import read_behavior, read_cell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.journal import NullJournal
from engine.messages import JointState
from engine.project.cell_runner import CellRunner
from engine.project.run_request import RunRequest
from engine.registry import load_states
from engine.runtime.plan import new_plan
from robots.scene.scene_builder import build_scene
from robots.sim.host.loop_timing import LoopTiming, TimingCounter, decode_timing
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import one_arm


def counted(*lates_s: float, overruns: int = 0) -> LoopTiming:
    """Return the figures of a loop that was so late, turn by turn."""
    counter = TimingCounter()
    for number, late_s in enumerate(lates_s):
        counter.count(late_s=late_s, overrun=number < overruns)
    return decode_timing(counter.values)


def test_the_behavior_has_no_findings_and_moves_both_arms_until_it_is_stopped(tmp_path: Path) -> None:
    catalogue = load_states()
    behavior, findings = read_behavior(BEHAVIOR, catalogue)
    assert findings == ()

    async def main() -> tuple[str, list[float]]:
        async with OpenCell(read_cell(None, behavior), store_path=str(tmp_path / "store.db")) as cell:
            before = [_joints(cell.bus, arm) for arm in ("left", "right")]
            parameters = {"controller": "cartesian_impedance"}
            request = RunRequest(plan=new_plan(behavior, catalogue), parameters=parameters)
            run = (await CellRunner(cell, NullJournal()).start(request)).run
            asyncio.get_running_loop().call_later(2.0, lambda: run.stop("it was long enough"))
            result = await run.execute()
            after = [_joints(cell.bus, arm) for arm in ("left", "right")]
            moved = [float(np.abs(b - a).max()) for a, b in zip(before, after, strict=True)]
            return result.status, moved

    status, moved = run_virtual(main())
    assert status == "stopped"
    assert min(moved) > 0.3


def test_the_cpu_of_a_process_and_of_those_it_started_is_counted() -> None:
    """A parent that only waits, its child that works until it has used some."""
    child = "import time\nwhile time.process_time() < 0.2: pass\nprint('used', flush=True)\ninput()"
    parent = f"import subprocess, sys; subprocess.run([sys.executable, '-I', '-c', {child!r}])"
    with subprocess.Popen(
        [sys.executable, "-I", "-c", parent], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as started:
        assert started.stdout is not None
        assert started.stdout.readline() == "used\n"
        family = descendants(started.pid)
        assert len(family) == 2
        assert cpu_s(family[1]) >= 0.15
        assert cpu_s(*family) >= cpu_s(family[1])
        started.communicate("\n")
    assert cpu_s(started.pid) == 0.0


async def test_a_world_is_watched_beside_an_empty_loop() -> None:
    host = ProcessHost(one_arm())
    async with SimWorld(one_arm(), host=host):
        watched = await watch(host, 0.5)
    assert watched.whole.steps > 0
    assert 0.0 < watched.empty_p99_s <= watched.empty_max_s
    assert (watched.quiet is None) == (watched.quiet_share == 0.0)


def test_times_of_one_loop_are_put_together() -> None:
    both = merged([counted(52e-6, 52e-6, overruns=1), counted(2e-3, overruns=1)])
    assert (both.steps, both.overruns, both.late_max_s) == (3, 2, 2e-3)
    assert both.late_p50_s == pytest.approx(55e-6)


def test_the_table_has_a_line_for_each_row_and_compares_them_in_quiet_time_only() -> None:
    rows = [_row("alone", counted(50e-6)), _row("busy", counted(101e-6)), _row("a", None), _row("b", None)]
    printed = table(rows).splitlines()
    assert [line.split("|")[1].strip() for line in printed if line.startswith("|")][2:] == ["alone", "busy", "a", "b"]
    assert [line for line in printed if "×" in line] == ["- busy: late p50 × 1.91, p99 × 1.91 of alone, in quiet time"]


def test_a_step_among_twenty_parts_is_taken_apart() -> None:
    """All parts lie on something and none in another: four contacts for a box, some for a cylinder."""
    scene = filled(build_scene(load_cell(CELL).document), 20, 0.002)
    assert (len(scene.parts), scene.step_s) == (22, 0.002)
    cost = step_cost(scene, "cartesian_impedance", 0.4)
    assert min(cost.cpu_s, cost.physics_s, cost.set_points_s, cost.laws_s, cost.rest_s) > 0.0
    assert min(cost.cpu_factor, cost.wall_factor) > 0.0
    assert 80 <= cost.contacts <= 110


def test_the_arms_swing_back_to_where_they_began() -> None:
    there, back = swings()
    assert there.position_rad[-1].tolist() == back.position_rad[0].tolist()
    assert back.position_rad[-1].tolist() == there.position_rad[0].tolist()


def _joints(bus: SkillBus, arm: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    state = bus.topic(f"{arm}/joint_state", JointState).latest
    assert state is not None
    return np.array(state.position_rad)


def _row(name: str, quiet: LoopTiming | None) -> Row:
    whole = counted(9e-3)
    share = 0.0 if quiet is None else 0.5
    punctuality = Punctuality(whole=whole, quiet=quiet, quiet_share=share, empty_p99_s=1e-3, empty_max_s=2e-3)
    return Row(name=name, punctuality=punctuality)
