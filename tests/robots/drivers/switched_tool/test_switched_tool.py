"""A gripper and a magnet on outputs: what is switched, what counts as held and by what evidence, and who permits it."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from engine.bus import GoalStatus
from engine.errors import RobotError
from engine.messages import GripperState
from engine.skills.devices import EnableDevice
from engine.skills.gripper import GripperGrasp, GripperMove, GripperOpen, ReadGripper
from robots.magnet.magnet_skills import MagnetResult, MagnetSwitch, ReadMagnet
from robots.port import MotionEnd
from robots.standard_tools.switched_gripper import SwitchedGripperPort
from tests.robots.drivers.switched_tool.switched_under_test import SENSOR, SwitchBox, detect, switched

GRIPPER, MAGNET = "left/gripper", "left/magnet"
GRASP = GripperGrasp(width_m=0.05, force_n=60.0)
BY_SENSOR: dict[str, Any] = {"sensor": {"topic": SENSOR}}
UNMEASURED = "nothing measures whether the {} holds a part"

pytestmark = pytest.mark.virtual


async def test_a_gripper_with_two_coils_closes_opens_and_takes_its_time() -> None:
    async with switched("gripper", release_output=1, hold_s=0.4, release_s=0.7, assume_held=True) as (bus, _, box):
        started_s = bus.clock.now_s()
        grasp = await bus.send_goal(GRASP, to=GRIPPER).result()
        assert bus.clock.now_s() - started_s == pytest.approx(0.4, abs=0.06)
        assert box.switched == [(1, False), (0, True)]
        assert grasp.result is not None
        assert (grasp.result.held, grasp.result.by, grasp.result.part) == (True, "not measured", "?")
        started_s = bus.clock.now_s()
        opened = await bus.send_goal(GripperOpen(), to=GRIPPER).result()
        assert (opened.status, box.switched[2:]) == (GoalStatus.SUCCEEDED, [(0, False), (1, True)])
        assert bus.clock.now_s() - started_s == pytest.approx(0.7, abs=0.06)
        assert not (await bus.call(ReadGripper(), to=GRIPPER)).held


async def test_without_sensor_and_assumption_nothing_is_held() -> None:
    """Nobody has said that it may be taken for held, and nothing tells it."""
    async with switched("gripper") as (bus, _, box):
        grasp = await bus.send_goal(GRASP, to=GRIPPER).result()
        assert grasp.result is not None
        assert (grasp.result.held, grasp.result.by) == (False, "not measured")
        assert grasp.result.reason == UNMEASURED.format("gripper")
        assert box.values[0]
    async with switched("magnet") as (bus, _, box):
        attracted = await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()
        assert attracted.result == MagnetResult(
            on=True, held=False, pull_n=0.0, reason=UNMEASURED.format("magnet"), by="not measured"
        )


@pytest.mark.parametrize(("inverted", "part"), [(False, True), (True, False)])
async def test_a_sensor_tells_whether_a_part_is_held_and_when_it_is_lost(inverted: bool, part: bool) -> None:
    sensor = {"topic": SENSOR, "inverted": inverted}
    async with switched("gripper", sensor=sensor) as (bus, _, _):
        detect(bus, part=part)
        before = await bus.call(ReadGripper(), to=GRIPPER)
        grasp = await bus.send_goal(GRASP, to=GRIPPER).result()
        assert grasp.result is not None
        assert (before.held, grasp.result.held, grasp.result.by, grasp.result.part) == (False, True, "sensor", "?")
        detect(bus, part=not part)
        assert not (await bus.call(ReadGripper(), to=GRIPPER)).held


async def test_a_sensor_that_detects_nothing_or_says_nothing_holds_nothing() -> None:
    async with switched("magnet", **BY_SENSOR) as (bus, _, _):
        silent = await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()
        detect(bus, part=False)
        empty = await bus.call(ReadMagnet(), to=MAGNET)
        assert silent.result is not None
        assert (silent.result.held, silent.result.reason) == (False, "the sensor of the magnet detects no part")
        assert (empty.on, empty.held, empty.by) == (True, False, "sensor")
        detect(bus, part=True)
        assert (await bus.call(ReadMagnet(), to=MAGNET)).held


async def test_a_magnet_that_is_taken_to_hold_lets_go_when_it_is_switched_off() -> None:
    async with switched("magnet", hold_output=2, assume_held=True) as (bus, _, box):
        attracted = await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()
        released = await bus.send_goal(MagnetSwitch(on=False), to=MAGNET).result()
        assert attracted.result == MagnetResult(on=True, held=True, pull_n=200.0, part="?", by="not measured")
        assert released.result is not None
        assert (released.result.held, released.result.reason) == (False, "the magnet is switched off")
        assert box.switched == [(2, True), (2, False)]


async def test_an_output_that_somebody_else_switches_is_seen() -> None:
    """The behavior may set it too: what is read back counts."""
    async with switched("magnet", assume_held=True) as (bus, _, box):
        await box.switch(0, on=True)
        assert (await bus.call(ReadMagnet(), to=MAGNET)).held


async def test_an_opening_in_between_is_refused_before_anything_is_switched() -> None:
    async with switched("gripper") as (bus, _, box):
        moved = await bus.send_goal(GripperMove(width_m=0.03), to=GRIPPER).result()
        assert moved.status is GoalStatus.ABORTED
        assert moved.cause is not None
        assert moved.cause.chain()[-1].message.startswith("an opening of 30.0 mm cannot be commanded")
        assert box.switched == []


async def test_nothing_is_switched_before_a_person_permits_it() -> None:
    async with switched("magnet", enable=False) as (bus, device, box):
        refused = await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()
        assert (refused.status, box.switched) == (GoalStatus.ABORTED, [])
        state = await bus.call(EnableDevice(reason="the cell is clear", by="ann"), to=MAGNET)
        assert (state.enabled, state.enabled_by, state.mode) == (True, "ann", "enabled")
        assert (await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()).status is GoalStatus.SUCCEEDED
        assert device.lost_reason == ""


async def test_who_permits_it_writes_one_line_of_the_log(caplog: pytest.LogCaptureFixture) -> None:
    async with switched("magnet", enable=False) as (bus, _, _):
        with caplog.at_level(logging.WARNING, logger="flexcell.devices"):
            await bus.call(EnableDevice(reason="looked\nERROR arm", by="eve\r"), to=MAGNET)
    assert caplog.messages == [f"{MAGNET} is enabled by eve: looked ERROR arm"]


async def test_a_lost_connection_of_the_outputs_takes_the_permission() -> None:
    async with switched("magnet", assume_held=True) as (bus, device, box):
        await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()
        box.lost_reason = "the cable is out"
        await bus.clock.sleep(0.2)
        lost = device.device_state()
        assert (lost.mode, lost.problem, lost.connected) == ("lost", "the cable is out", False)
        with pytest.raises(RobotError, match="the cable is out"):
            await bus.call(ReadMagnet(), to=MAGNET)
        await box.reconnect()
        refused = await bus.send_goal(MagnetSwitch(on=False), to=MAGNET).result()
        assert (refused.status, device.device_state().mode) == (GoalStatus.ABORTED, "stopped")
        assert (await bus.call(ReadMagnet(), to=MAGNET)).held
        await bus.call(EnableDevice(reason="cable is in"), to=MAGNET)
        assert (await bus.send_goal(MagnetSwitch(on=False), to=MAGNET).result()).status is GoalStatus.SUCCEEDED


async def test_an_output_that_is_not_set_is_the_cause_of_the_failure() -> None:
    box = SwitchBox()
    box.refusal = "gripperON was not confirmed"
    async with switched("gripper", box=box, assume_held=True) as (bus, _, _):
        grasp = await bus.send_goal(GRASP, to=GRIPPER).result()
        assert grasp.status is GoalStatus.ABORTED
        assert grasp.cause is not None
        assert grasp.cause.chain()[-1].message == "left: gripperON was not confirmed"


async def test_outputs_that_the_device_does_not_have_permit_nothing() -> None:
    async with switched("gripper", enable=False, hold_output=7) as (bus, _, _):
        with pytest.raises(RobotError, match=r"left: there is no output 7 .*0 to 3"):
            await bus.call(EnableDevice(reason="a test"), to=GRIPPER)


async def test_a_stop_waits_for_the_end_and_keeps_the_outputs() -> None:
    async with switched("gripper", hold_s=0.5, assume_held=True) as (bus, device, box):
        goal = bus.send_goal(GRASP, to=GRIPPER)
        await goal.accepted()
        await bus.clock.sleep(0.1)
        await device.stop()
        assert (device.drive.motion, box.values[0]) == (None, True)
        assert (await goal.result()).status is not GoalStatus.SUCCEEDED
        assert device.drive.reading().contact == "?"


async def test_a_motion_that_is_canceled_ends_in_its_time_and_one_at_a_time_is_taken() -> None:
    async with switched("gripper", hold_s=0.5) as (bus, device, _):
        port = SwitchedGripperPort(device.drive)
        motion = port.close_to(width_m=0.0, speed_m_s=0.1, force_n=10.0)
        with pytest.raises(RobotError, match="another motion is active"):
            port.close_to(width_m=0.085, speed_m_s=0.1, force_n=10.0)
        await bus.clock.sleep(0.25)
        assert (motion.progress, port.sample().width_m) == (pytest.approx(0.5), pytest.approx(0.0425))
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED
        assert port.sample().width_m == 0.0


async def test_the_state_on_the_bus_follows() -> None:
    async with switched("gripper", **BY_SENSOR) as (bus, _, _):
        detect(bus, part=True)
        await bus.send_goal(GRASP, to=GRIPPER).result()
        await bus.clock.sleep(0.1)
        latest = bus.topic(f"{GRIPPER}/state", GripperState).latest
        assert latest is not None
        assert (latest.held, latest.by) == (True, "sensor")
