"""The control services of an arm: what they put into force, whom they refuse, what they tell."""

from __future__ import annotations

import asyncio
from typing import Any

import msgspec
import numpy as np
import pytest

from engine.bus import Holder
from engine.errors import LeaseRefused, SkillFailed
from engine.messages import Pose
from engine.skill import Service
from engine.skills.arm_control import (
    ArmStatus,
    ControlSettings,
    ReadArm,
    RecoverFromError,
    SetCartesianImpedance,
    SetCollisionBehavior,
    SetController,
    SetEndEffectorFrame,
    SetJointImpedance,
    SetLoad,
    SetSpeedOverride,
    SpeedOverride,
)
from engine.skills.motion import CartTrapVel, ForwardKinematics
from tests.robots.arm.served import HOME, MOVE, served
from tests.robots.fake_port import FakeArmPort

SETTINGS: list[tuple[Service[ControlSettings], ControlSettings]] = [
    (SetController(controller="cartesian_impedance"), ControlSettings(controller="cartesian_impedance")),
    (
        SetJointImpedance(stiffness_nm_rad=(400.0,) * 7, damping_ratio=0.7),
        ControlSettings(joint_stiffness_nm_rad=(400.0,) * 7, joint_damping_ratio=0.7),
    ),
    (
        SetCartesianImpedance(stiffness=(800.0, 800.0, 300.0, 40.0, 40.0, 40.0), nullspace_stiffness_nm_rad=5.0),
        ControlSettings(cartesian_stiffness=(800.0, 800.0, 300.0, 40.0, 40.0, 40.0), nullspace_stiffness_nm_rad=5.0),
    ),
    (SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.1)), ControlSettings(tool_xyz_m=(0.0, 0.0, 0.1))),
    (SetLoad(mass_kg=1.2, com_m=(0.0, 0.0, 0.03)), ControlSettings(load_kg=1.2, load_com_m=(0.0, 0.0, 0.03))),
    (
        SetCollisionBehavior(torque_nm=(20.0,) * 7, force_n=30.0),
        ControlSettings(collision_torque_nm=(20.0,) * 7, collision_force_n=30.0),
    ),
    (SetSpeedOverride(share=0.3), ControlSettings(speed_override=0.3)),
]

FOR_ALL: tuple[Service[Any], ...] = (ReadArm(), SetSpeedOverride(share=0.5), RecoverFromError())


@pytest.mark.virtual
@pytest.mark.parametrize(("request_", "due"), SETTINGS, ids=lambda value: type(value).__name__)
async def test_a_service_changes_its_own_settings_and_answers_with_what_is_in_force(
    request_: Service[ControlSettings], due: ControlSettings
) -> None:
    """And with nothing else."""
    async with served() as cell:
        answer = await cell.bus.call(request_, to="left")
        assert cell.port.settings == due
    assert msgspec.to_builtins(answer) == msgspec.to_builtins(due)


@pytest.mark.virtual
async def test_what_the_arm_cannot_have_is_refused_with_the_reason_and_changes_nothing() -> None:
    """Two values for seven joints."""
    async with served() as cell:
        with pytest.raises(SkillFailed, match="there is not one value a joint"):
            await cell.bus.call(SetJointImpedance(stiffness_nm_rad=(400.0, 400.0)), to="left")
        assert cell.port.settings == ControlSettings()


@pytest.mark.virtual
async def test_another_end_effector_frame_is_what_cartesian_goals_mean() -> None:
    """The same pose is reached with a point 10 cm before the hand; the hand stays 10 cm behind."""
    goal = Pose(xyz=(-0.15, 0.2, 0.3), xyzw=(1.0, 0.0, 0.0, 0.0))
    async with served() as cell:
        before = await cell.bus.call(ForwardKinematics(), to="left")
        await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.1)), to="left")
        shifted = await cell.bus.call(ForwardKinematics(), to="left")
        end = await cell.bus.send_goal(CartTrapVel(pose=goal, speed=0.5), to="left").result()
        await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.0)), to="left")
        hand = await cell.bus.call(ForwardKinematics(), to="left")
    assert end.result is not None
    assert np.linalg.norm(np.subtract(shifted.xyz, before.xyz)) == pytest.approx(0.1)
    assert np.allclose(end.result.pose.xyz, goal.xyz, atol=1e-4)
    assert np.allclose(hand.xyz, (-0.15, 0.2, 0.4), atol=1e-4)


@pytest.mark.virtual
async def test_the_end_effector_frame_stays_while_a_goal_means_it() -> None:
    """Refused, and accepted after the goal."""
    async with served() as cell:
        handle = await cell.begun(MOVE)
        with pytest.raises(SkillFailed, match="busy with joint_trap_vel"):
            await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.1)), to="left")
        await handle.result()
        await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.1)), to="left")


@pytest.mark.virtual
async def test_while_a_run_holds_the_arm_others_may_only_read_slow_down_and_recover() -> None:
    """The run itself may do everything."""
    run = Holder("run-1", "root/a")
    async with served() as cell:
        cell.bus.leases.acquire(("left",), run)
        for request, _ in SETTINGS[:-1]:
            with pytest.raises(LeaseRefused, match="left is commanded by run run-1"):
                await cell.bus.call(request, to="left")
        for allowed in FOR_ALL:
            await cell.bus.call(allowed, to="left")
        for request, _ in SETTINGS:
            await cell.bus.call(request, to="left", holder=run)


@pytest.mark.virtual
async def test_half_the_speed_override_takes_twice_the_time() -> None:
    """And its topic has the share."""
    async with served() as cell:
        full = await cell.bus.send_goal(MOVE, to="left").result()
        await cell.bus.call(SetSpeedOverride(share=0.5), to="left")
        half = await cell.bus.send_goal(HOME, to="left").result()
        assert cell.bus.topic("left/speed_override", SpeedOverride).latest == SpeedOverride(share=0.5)
    assert full.result is not None
    assert half.result is not None
    assert half.result.duration_s == pytest.approx(2 * full.result.duration_s, rel=0.05)


@pytest.mark.virtual
async def test_the_status_is_reported_at_every_change_and_names_what_goes_on() -> None:
    """Connected, moving, at rest, other settings, reflex, recovered."""
    async with served() as cell:
        topic = cell.bus.topic("left/status", ArmStatus)
        first = topic.latest
        heard: list[ArmStatus] = []
        topic.subscribe(heard.append)
        handle = await cell.begun(MOVE)
        await handle.result()
        await cell.bus.call(SetLoad(mass_kg=1.0), to="left")
        handle = await cell.begun(HOME)
        cell.port.trip("panda_joint2 feels 31 Nm")
        await handle.result()
        await cell.bus.call(RecoverFromError(), to="left")
    assert first is not None
    assert first.mode == "idle"
    assert [(status.mode, status.activity, bool(status.error)) for status in heard] == [
        ("moving", "joint_trap_vel", False),
        ("idle", "", False),
        ("idle", "", False),
        ("moving", "joint_trap_vel", False),
        ("reflex", "", True),
        ("idle", "", False),
        ("disconnected", "", False),
    ]
    assert heard[2].settings.load_kg == 1.0
    assert "panda_joint2 feels 31 Nm" in heard[4].error


@pytest.mark.virtual
async def test_after_a_reflex_goals_are_rejected_until_it_is_recovered_from() -> None:
    """With what to do about it."""
    async with served() as cell:
        cell.port.trip("external force 41 N")
        rejected = await cell.bus.send_goal(MOVE, to="left").result()
        assert await cell.mode() == "reflex"
        status = await cell.bus.call(RecoverFromError(), to="left")
        accepted = await cell.bus.send_goal(MOVE, to="left").result()
    assert rejected.cause is not None
    assert (rejected.status.value, accepted.status.value, status.mode) == ("rejected", "succeeded", "idle")
    assert "recover_from_error" in str(rejected.cause.message) + str(rejected.cause)


@pytest.mark.virtual
async def test_a_reflex_of_an_idle_arm_is_reported_at_once_with_its_reason_until_it_is_recovered_from() -> None:
    """Nobody has to ask, and no time passes; the rejection says it as well."""
    async with served() as cell:
        heard: list[ArmStatus] = []
        cell.bus.topic("left/status", ArmStatus).subscribe(heard.append)
        cell.port.trip("panda_joint2 feels 31 Nm")
        assert [(status.mode, status.error) for status in heard] == [
            ("reflex", "the arm has stopped by itself: panda_joint2 feels 31 Nm")
        ]
        rejected = await cell.bus.send_goal(MOVE, to="left").result()
        assert rejected.cause is not None
        assert "stopped by itself: panda_joint2 feels 31 Nm" in rejected.cause.message
        assert (await cell.bus.call(RecoverFromError(), to="left")).error == ""


class SlowController(FakeArmPort):
    """A port whose controller adopts tool and load when the test says so."""

    settings_are_applied = False


@pytest.mark.virtual
async def test_a_load_is_set_when_the_controller_has_adopted_it() -> None:
    """It may take its set point anew with it, from which the next motion is planned."""
    async with served(port_type=SlowController) as cell:
        port = cell.port
        assert isinstance(port, SlowController)
        setting = asyncio.ensure_future(cell.bus.call(SetLoad(mass_kg=1.0), to="left"))
        await cell.bus.clock.sleep(2.0)
        assert (setting.done(), port.settings.load_kg) == (False, 1.0)
        port.settings_are_applied = True
        assert (await setting).load_kg == 1.0


@pytest.mark.virtual
async def test_a_controller_that_does_not_adopt_its_tool_is_the_cause() -> None:
    async with served(port_type=SlowController) as cell:
        with pytest.raises(SkillFailed, match="did not adopt tool and load within 10 s"):
            await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.1)), to="left")
