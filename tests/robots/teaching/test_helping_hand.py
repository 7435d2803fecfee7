"""The Helping Hand in physics: buttons capture poses and a motion led by hand, which become named entries (row T1)."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from engine.errors import FlexcellError
from engine.messages import Pose
from engine.messages.primitives import JointDmp
from engine.skills.entries import ReadEntry
from engine.skills.motion import ForwardKinematics, JointTrapVel
from engine.skills.simulated_world import PushBody
from engine.skills.teaching import (
    ButtonState,
    Callback,
    FireTrigger,
    ReadCapture,
    ReadTeachStatus,
    SaveCapture,
    SetTriggers,
    Trigger,
    TriggerType,
)
from engine.store import SqliteStore, register_store
from engine.store.entry_kinds import Joints, decode_entry
from engine.teaching import HelpingHand
from tests.robots.arm.simulated import HOME, Simulated, simulated


def trigger(name: str, callback: Callback, kind: TriggerType = "rising_edge", robot: str = "/left") -> Trigger:
    return Trigger(
        trig_name=name, robot_ns=robot, trig_topic=f"/keypress/{name}", trig_type=kind, trig_callback=callback
    )


TRIGGERS = (
    trigger("previous", "joint_save"),
    trigger("play_pause", "grav_comp"),
    trigger("next", "joint_dmp_save", "hold"),
    trigger("pose", "pose_save", "falling_edge", robot="/"),
    trigger("cart", "cart_dmp_save"),
)


class Taught(Simulated):
    """A simulated arm with buttons."""

    def press(self, button: str, *, value: bool = True) -> None:
        self.bus.topic(f"keypress/{button}", ButtonState).publish(ButtonState(value=value))

    async def lead(self, force_n: tuple[float, float, float]) -> None:
        await self.bus.call(PushBody(body="left/panda_hand", force_n=force_n, duration_s=0.5), to="cell")
        await self.bus.clock.sleep(0.6)


@asynccontextmanager
async def taught(folder: Path | None = None) -> AsyncGenerator[Taught]:
    async with simulated() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        async with HelpingHand(cell.bus, robots=("left",), folder=folder, triggers=TRIGGERS):
            yield Taught(**vars(cell))


@pytest.mark.virtual
async def test_buttons_teach_two_poses_and_a_motion(tmp_path: Path) -> None:
    async with taught(tmp_path) as cell:
        await cell.perform(HOME)
        cell.press("previous")
        cell.press("previous", value=False)
        await cell.bus.clock.sleep(0.1)
        cell.press("play_pause")
        await cell.bus.clock.sleep(0.3)
        assert (await cell.bus.call(ReadTeachStatus(), to="teach")).guided == ("left",)
        cell.press("next")
        await cell.lead((0.0, 14.0, -4.0))
        await cell.lead((0.0, -4.0, 8.0))
        cell.press("next", value=False)
        await cell.bus.clock.sleep(0.1)
        cell.press("play_pause", value=False)
        cell.press("play_pause")
        await cell.bus.clock.sleep(0.5)
        cell.press("pose")
        cell.press("pose", value=False)
        await cell.bus.clock.sleep(0.1)
        status = await cell.bus.call(ReadTeachStatus(), to="teach")
        assert [one.form for one in status.captures] == ["joints", "dmp", "pose"], status.message
        assert status.guided == ()
        assert status.recording == ()
        motion = await cell.bus.call(ReadCapture(id=2), to="teach")
        assert motion.joint_fit is not None
        assert motion.joint_fit.max_rad < 5e-3
        assert motion.summary.samples > 100
        assert motion.summary.length_rad > 0.1
        for number, name in ((1, "above"), (2, "sweep"), (3, "left_there")):
            await cell.bus.call(SaveCapture(id=number, name=name), to="teach")
        above = decode_entry(await cell.bus.call(ReadEntry(kind="joints", name="above"), to="store"), Joints)
        sweep = decode_entry(await cell.bus.call(ReadEntry(kind="dmp", name="sweep"), to="store"), JointDmp)
        there = decode_entry(await cell.bus.call(ReadEntry(kind="pose", name="left_there"), to="store"), Pose)
        tool = await cell.bus.call(ForwardKinematics(), to="left")
        assert np.allclose(above.joints, HOME.joints, atol=0.01)
        assert np.linalg.norm(np.subtract(there.xyz, tool.xyz)) < 1e-3
        assert np.ptp(np.array([sweep.start, sweep.goal]), axis=0).max() > 0.05
    # What was captured is there for the next one who teaches.
    async with taught(tmp_path) as cell:
        again = await cell.bus.call(ReadTeachStatus(), to="teach")
        assert [one.saved_as for one in again.captures] == [("joints above",), ("dmp sweep",), ("pose left_there",)]


@pytest.mark.virtual
async def test_a_cartesian_primitive_is_within_two_millimetres_of_the_demonstration() -> None:
    async with taught() as cell:
        await cell.perform(HOME)
        cell.press("cart")
        await cell.perform(JointTrapVel(joints=(*HOME.joints[:1], HOME.joints[1] + 0.3, *HOME.joints[2:]), speed=0.2))
        cell.press("cart", value=False)
        cell.press("cart")
        await cell.bus.clock.sleep(0.1)
        capture = await cell.bus.call(ReadCapture(id=1), to="teach")
        assert capture.cart_fit is not None
        assert capture.cart_fit.rms_m < 2e-3
        await cell.bus.call(SaveCapture(id=1, name="raw", form="trajectory"), to="teach")
        await cell.bus.call(SaveCapture(id=1, name="last", form="joints"), to="teach")
        with pytest.raises(FlexcellError):
            await cell.bus.call(SaveCapture(id=1, name="last", form="joints"), to="teach")
        await cell.bus.call(SaveCapture(id=1, name="last", form="joints", replace=True), to="teach")


@pytest.mark.virtual
async def test_what_cannot_be_done_is_said_and_teaching_goes_on() -> None:
    wrong = (
        trigger("nobody", "joint_save", robot="/middle"),
        trigger("short", "joint_dmp_save", "hold"),
        trigger("good", "joint_save"),
    )
    async with taught() as cell:
        await cell.bus.call(SetTriggers(triggers=wrong), to="teach")
        said = (await cell.bus.call(FireTrigger(trig_name="nobody"), to="teach")).message
        assert said == "nobody: there is no robot middle (left)"
        cell.press("short")
        cell.press("short", value=False)
        await cell.bus.clock.sleep(0.1)
        said = (await cell.bus.call(ReadTeachStatus(), to="teach")).message
        assert "the recording is too short" in said
        status = await cell.bus.call(FireTrigger(trig_name="good"), to="teach")
        assert [one.form for one in status.captures] == ["joints"]
        with pytest.raises(FlexcellError, match="cannot be saved as dmp"):
            await cell.bus.call(SaveCapture(id=1, name="x", form="dmp"), to="teach")
        with pytest.raises(FlexcellError, match="there is no trigger 'other'"):
            await cell.bus.call(FireTrigger(trig_name="other"), to="teach")
