"""CartAdmitDMP over a fake port: what force control is asked for, and what a pass has learned."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.messages.primitives import CartDmp, ForceReference
from engine.skills.dmp import CartAdmitDMP, CartAdmitFeedback, Compliance, LearnCartDmp
from robots.motion.dmp import offsets_at, phase_at
from robots.port import Array, ForceRecord
from tests.robots.arm.served import Served, served
from tests.robots.arm.test_dmp_motions import led

PRESS = ForceReference.constant(force_n=(0.0, 0.0, 10.0))
SHARES = np.linspace(0.0, 1.0, 200)


def record(offset_m: Array, force_n: Array) -> ForceRecord:
    """A pass with these offsets along z and forces along z."""
    offset, wrench = np.zeros((len(SHARES), 6)), np.zeros((len(SHARES), 6))
    offset[:, 2], wrench[:, 2] = offset_m, force_n
    return ForceRecord.of(share=SHARES, offset=offset, wrench=wrench)


async def primitive(cell: Served) -> CartDmp:
    """A Cartesian primitive that starts at home."""
    return (await cell.bus.call(LearnCartDmp(trajectory=led()), to="left")).dmp


@pytest.mark.virtual
async def test_a_pass_returns_what_it_learned_and_the_next_one_starts_with_it() -> None:
    """RCL table 8: the offsets of the executed movement, to be used in the next iteration."""
    dip = -0.004 * np.sin(np.pi * SHARES)
    async with served() as cell:
        dmp = await primitive(cell)
        cell.port.force_record = record(dip, np.full(len(SHARES), 8.0))
        told: list[CartAdmitFeedback] = []
        goal = cell.bus.send_goal(CartAdmitDMP(dmp=dmp, force=PRESS, slow_per_n=0.1), to="left")
        goal.on_feedback(told.append)
        first = await goal.result()
    assert first.result is not None
    assert first.result.offsets is not None
    learned = offsets_at(first.result.offsets, phase_at(SHARES, dmp.a_x))
    assert learned[:, 2] == pytest.approx(dip, abs=1e-4)
    assert (first.result.force_error_rms_n, first.result.force_error_max_n) == pytest.approx((2.0, 2.0))
    assert told[-1].progress == pytest.approx(1.0)
    assert told[-1].wrench.frame == "world"
    async with served() as cell:
        cell.port.force_record = record(dip, np.full(len(SHARES), 10.0))
        goal = cell.bus.send_goal(CartAdmitDMP(dmp=dmp, force=PRESS, offsets=first.result.offsets), to="left")
        second = await goal.result()
        task = cell.port.tracked[0]
    samples = np.linspace(0.0, 1.0, len(task.trajectory.position_rad))
    assert task.offset[:, 2] == pytest.approx(-0.004 * np.sin(np.pi * samples), abs=1e-4)
    assert second.result is not None
    assert second.result.offsets is not None
    kept = offsets_at(second.result.offsets, phase_at(SHARES, dmp.a_x))
    assert kept[:, 2] == pytest.approx(dip, abs=1e-4)
    assert second.result.force_error_rms_n == pytest.approx(0.0)


@pytest.mark.virtual
async def test_the_task_is_what_was_asked_for() -> None:
    """Forces over the path, gains, phase stopping, and the axes of the tool as it stands."""
    compliance = Compliance(
        frame="tool", active=(0.0, 1.0, 0.0, 0.0, 0.0, 0.0), damping=(200.0, 200.0, 200.0, 5.0, 5.0, 5.0)
    )
    async with served() as cell:
        dmp = await primitive(cell)
        goal = CartAdmitDMP(dmp=dmp, force=PRESS, compliance=compliance, slow_per_n=0.3, N=20)
        end = await cell.bus.send_goal(goal, to="left").result()
        task = cell.port.tracked[0]
    assert task.wrench == pytest.approx(np.tile([0.0, 0.0, 10.0, 0.0, 0.0, 0.0], (len(task.wrench), 1)))
    assert (task.slow_per_n, task.admittance.active, task.admittance.damping) == (
        0.3,
        compliance.active,
        compliance.damping,
    )
    start = np.array(dmp.y0[3:])
    assert abs(float(np.array(task.task_xyzw) @ start)) == pytest.approx(1.0, abs=1e-4)
    assert math.hypot(*task.task_xyzw) == pytest.approx(1.0)
    assert end.result is not None
    assert end.result.offsets is not None
    assert len(end.result.offsets.c_o) == 20


@pytest.mark.virtual
async def test_offsets_beyond_the_reach_are_cut_off_there() -> None:
    """What an earlier, wider pass learned does no harm."""
    async with served() as cell:
        dmp = await primitive(cell)
        cell.port.force_record = record(np.full(len(SHARES), 0.04), np.full(len(SHARES), 10.0))
        first = await cell.bus.send_goal(CartAdmitDMP(dmp=dmp, force=PRESS), to="left").result()
    assert first.result is not None
    narrow = Compliance(reach_m=0.01)
    async with served() as cell:
        goal = CartAdmitDMP(dmp=dmp, force=PRESS, compliance=narrow, offsets=first.result.offsets)
        await cell.bus.send_goal(goal, to="left").result()
        task = cell.port.tracked[0]
    assert np.abs(task.offset).max() == pytest.approx(0.01)


@pytest.mark.virtual
async def test_a_preempted_pass_returns_where_the_tool_is_and_no_offsets() -> None:
    """RCL 4.3.7: in case of preemption just the pose."""
    async with served() as cell:
        dmp = await primitive(cell)
        goal = await cell.begun(CartAdmitDMP(dmp=dmp, force=PRESS))
        goal.cancel()
        end = await goal.result()
    assert end.status is GoalStatus.CANCELED
    assert end.result is None or end.result.offsets is None


def test_gains_that_make_no_admittance_are_refused() -> None:
    """Before anything is sent."""
    with pytest.raises(msgspec.ValidationError, match="`damping` is above 0"):
        msgspec.convert({"damping": [0, 1, 1, 1, 1, 1]}, Compliance)
    with pytest.raises(msgspec.ValidationError, match="`active` is from 0 to 1"):
        msgspec.convert({"active": [0, 0, 2, 0, 0, 0]}, Compliance)
