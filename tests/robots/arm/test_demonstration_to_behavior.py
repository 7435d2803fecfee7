"""From demonstration to behavior in physics: led by hand, saved, proposed, checked and carried out by the arm."""

from __future__ import annotations

import asyncio
from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.check import check_behavior
from engine.document.loader import parse_behavior
from engine.journal import NullJournal
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from engine.skills.dmp import JointDMP
from engine.skills.entries import ListEntries
from engine.skills.gripper import GripperMove, GripperSetting
from engine.skills.motion import ForwardKinematics, JointTrapVel
from engine.skills.proposing import Proposal, ProposeBehavior, TaughtStep
from engine.skills.simulated_world import PushBody
from engine.skills.teaching import Callback, Capture, CaptureForm, ReadCapture, SaveCapture, TeachNow
from engine.store import SqliteStore, register_store
from engine.store.entry_kinds import Joints, decode_entry
from engine.teaching import HelpingHand
from robots.port import Array
from tests.robots.arm.simulated import HOME, Simulated, simulated

GATHERS_PACE_S = 0.07
RAISED = JointTrapVel(joints=(*HOME.joints[:3], HOME.joints[3] + 0.3, *HOME.joints[4:]), speed=0.5)


async def capture(cell: Simulated, callback: Callback, name: str, form: CaptureForm | None = None) -> Capture:
    """Capture what is now, and save it."""
    status = await cell.bus.call(TeachNow(callback=callback, robot="left"), to="teach")
    return await saved(cell, status.captures[-1].id, name, form)


async def saved(cell: Simulated, number: int, name: str, form: CaptureForm | None = None) -> Capture:
    """Save a capture, and return it."""
    await cell.bus.call(SaveCapture(id=number, name=name, form=form), to="teach")
    return await cell.bus.call(ReadCapture(id=number), to="teach")


async def led(cell: Simulated) -> int:
    """Lead the arm by hand while it is recorded; return the number of the capture."""
    await cell.bus.call(TeachNow(callback="grav_comp", robot="left"), to="teach")
    await cell.bus.clock.sleep(0.3)
    await cell.bus.call(TeachNow(callback="joint_dmp_save", robot="left"), to="teach")
    for force_n in ((0.0, 14.0, -4.0), (0.0, -4.0, 8.0)):
        await cell.bus.call(PushBody(body="left/panda_hand", force_n=force_n, duration_s=0.5), to="cell")
        await cell.bus.clock.sleep(0.6)
    await cell.bus.clock.sleep(0.6)
    status = await cell.bus.call(TeachNow(callback="joint_dmp_save", robot="left", pressed=False), to="teach")
    await cell.bus.call(TeachNow(callback="grav_comp", robot="left", pressed=False), to="teach")
    await cell.bus.clock.sleep(0.3)
    return status.captures[-1].id


async def run(cell: Simulated, proposal: Proposal, folder: Path) -> RunResult:
    """Check the proposed behavior against what the store holds, and execute it."""
    behavior = parse_behavior(proposal.text, file=folder / "taught.yaml")
    listed = await cell.bus.call(ListEntries(), to="store")
    names: dict[str, set[str]] = {}
    for kind, name, _ in listed.entries:
        names.setdefault(kind, set()).add(name)
    assert check_behavior(behavior, load_states(), names) == ()
    journal = NullJournal().begin("taught", behavior="", document="", started_unix_s=0.0)
    plan = new_plan(behavior, load_states())
    return await Run(plan, run="taught", bus=cell.bus, parameters={}, inputs={}, seed=0, journal=journal).execute()


async def carried_out(cell: Simulated, goal: JointDMP) -> tuple[list[float], list[tuple[float, ...]]]:
    """The times since the goal began and the measured joints, every ten milliseconds."""
    handle = await cell.begun(goal, after_s=0.0)
    start_s, ended = cell.bus.clock.now_s(), asyncio.ensure_future(handle.result())
    times: list[float] = []
    joints: list[tuple[float, ...]] = []
    while not ended.done():
        times.append(cell.bus.clock.now_s() - start_s)
        joints.append(tuple(cell.joints().tolist()))
        await cell.bus.clock.sleep(0.01)
    assert (await ended).status is GoalStatus.SUCCEEDED
    return times, joints


async def tool_rms_m(
    cell: Simulated, shown: Trajectory, start_s: float, times: list[float], joints: list[tuple[float, ...]]
) -> float:
    """How far the tool was off the demonstration (RMS).

    Its controller is some milliseconds behind, and a primitive that begins with a push gathers pace within the jerk
    limits, by which the rest of it comes up to `GATHERS_PACE_S` later.
    """
    due_s = np.array(shown.times_s) - start_s
    wanted: Array = np.array(shown.joints)
    made: Array = np.array([await place(cell, one) for one in joints])
    rms: list[float] = []
    for late_s in np.arange(0.0, GATHERS_PACE_S, 0.002).tolist():
        within = [index for index, time_s in enumerate(times) if 0.0 <= time_s - late_s <= due_s[-1]]
        then = [[float(np.interp(times[index] - late_s, due_s, wanted[:, n])) for n in range(7)] for index in within]
        should: Array = np.array([await place(cell, tuple(one)) for one in then])
        away = made[within] - should
        rms.append(float(np.sqrt((away**2).sum(axis=1).mean())))
    return min(rms)


async def place(cell: Simulated, joints: tuple[float, ...]) -> tuple[float, float, float]:
    """Where the tool is with these joints."""
    return (await cell.bus.call(ForwardKinematics(joints=joints), to="left")).xyz


@pytest.mark.virtual
async def test_places_a_motion_and_the_gripper_are_taught_and_the_proposed_behavior_does_the_same(
    tmp_path: Path,
) -> None:
    """Joints with names and model, a motion led by hand, an open gripper: one behavior, which ends as it was shown."""
    async with simulated() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        async with HelpingHand(cell.bus, robots=("left",)):
            await cell.perform(HOME)
            await capture(cell, "joint_save", "home")
            number = await led(cell)
            await saved(cell, number, "wave")
            await saved(cell, number, "wave_as_it_was", "trajectory")
            await cell.perform(RAISED)
            await capture(cell, "pose_save", "raised")
            await cell.bus.send_goal(GripperMove(width_m=0.02), to="left/gripper").result()
            opened = await capture(cell, "gripper_save", "narrow")
            await cell.perform(HOME)
            steps = [
                TaughtStep(kind="joints", name="home"),
                TaughtStep(kind="dmp", name="wave"),
                TaughtStep(kind="trajectory", name="wave_as_it_was"),
                TaughtStep(kind="gripper", name="narrow"),
                TaughtStep(kind="pose", name="raised"),
            ]
            proposal = await cell.bus.call(ProposeBehavior(steps=tuple(steps)), to="teach")
            result = await run(cell, proposal, tmp_path)
        home = decode_entry(await store.get("joints", "home"), Joints)
        gripper = decode_entry(await store.get("gripper", "narrow"), GripperSetting)
        tool = await cell.tool()
        raised = decode_entry(await store.get("pose", "raised"), Pose)
    assert (home.model, len(home.names)) == ("panda", 7)
    assert opened.gripper == gripper
    assert (gripper.held, gripper.width_m) == (False, pytest.approx(0.02, abs=2e-3))
    assert proposal.words == (
        "Move to home", "Move to the start of wave", "Follow wave", "Move to the start of wave_as_it_was",
        "Follow wave_as_it_was", "Release", "Move to raised",
    )  # fmt: skip
    assert (result.outcome, result.success) == ("finished", True), result.cause
    assert np.linalg.norm(np.subtract(tool.xyz, raised.xyz)) < 2e-3


@pytest.mark.virtual
async def test_a_motion_led_by_hand_is_repeated_within_two_millimetres() -> None:
    """The learned primitive, and the measured motion of the arm along it: RMS of the tool against the demonstration."""
    async with simulated() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        async with HelpingHand(cell.bus, robots=("left",)):
            await cell.perform(HOME)
            number = await led(cell)
            taught = await saved(cell, number, "wave")
            cart = await saved(cell, number, "wave", "cart_dmp")
            assert taught.joint_dmp is not None
            assert taught.joint_fit is not None
            assert cart.cart_fit is not None
            assert taught.trajectory is not None
            await cell.perform(JointTrapVel(joints=taught.joint_dmp.start, speed=0.5))
            times, joints = await carried_out(cell, JointDMP(dmp=taught.joint_dmp))
            measured_m = await tool_rms_m(cell, taught.trajectory, taught.joint_fit.cut.start_s, times, joints)
    assert np.ptp(np.array(taught.trajectory.joints), axis=0).max() > 0.1
    assert taught.joint_fit.rms_m is not None
    assert taught.joint_fit.rms_rad < 2e-3
    assert taught.joint_fit.rms_m < 2e-3
    assert cart.cart_fit.rms_m < 2e-3
    assert measured_m < 2e-3
