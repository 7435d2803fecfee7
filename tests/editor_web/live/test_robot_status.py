"""The strip of arms in the live stream: every arm of the bus, its newest line, and only what has changed."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import msgspec

from editor_web.live.hub import LiveClient, LiveHub
from editor_web.live.live_frames import LiveDelta, LiveSnapshot
from editor_web.live.robot_status import RobotStatusCache
from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.journal import Journal
from engine.messages import JointState
from engine.messages.separation import SeparationState
from engine.project.session import Session
from engine.skills.arm_control import SetSpeedOverride
from engine.skills.planning import PathPreview
from tests.editor_web.fake_arm import FakeArm
from tests.editor_web.fake_sights import planned_path


@asynccontextmanager
async def hub_of_two_arms(folder: Path) -> AsyncGenerator[tuple[SkillBus, LiveHub, FakeArm]]:
    """A hub that follows a bus with two arms and a topic of another kind."""
    with Journal.open(folder) as journal:
        async with OpenCell(None) as cell, Session(cell, project=folder, catalogue={}, journal=journal) as session:
            arm = FakeArm(cell.bus, "left")
            FakeArm(cell.bus, "right")
            cell.bus.topic("left/joints", JointState)
            hub = LiveHub(session)
            await hub.robots.open()
            yield cell.bus, hub, arm
            hub.robots.close()


def delta(client: LiveClient) -> LiveDelta:
    """The next frame, which must be a delta."""
    frame = client.frame()
    assert isinstance(frame, LiveDelta)
    return frame


async def test_a_page_gets_all_arms_first_and_then_those_that_changed(tmp_path: Path) -> None:
    async with hub_of_two_arms(tmp_path) as (bus, hub, arm):
        client = hub.join()
        first = client.frame()
        assert isinstance(first, LiveSnapshot)
        assert {name: line.mode for name, line in first.robots.items()} == {"left": "idle", "right": "idle"}
        arm.become("moving", activity="move_joints")
        arm.become("reflex", error="pushed")
        await bus.call(SetSpeedOverride(share=0.25), to="left")
        line = delta(client).robots["left"]
        assert (line.mode, line.activity, line.error, line.speed_override) == ("reflex", "", "pushed", 0.25)
        assert client.frame() is None
        arm.become("moving", activity="cart_lin_task")
        assert delta(client).robots["left"].activity == "line to a pose"
        arm.become("moving", activity="to tray")
        assert delta(client).robots["left"].activity == "to tray"


async def test_the_way_of_an_arm_is_reported_with_what_blocks_it_and_since_when(tmp_path: Path) -> None:
    """Another reason is the same wait; a way that is over is none."""
    with Journal.open(tmp_path) as journal:
        async with OpenCell(None) as cell, Session(cell, project=tmp_path, catalogue={}, journal=journal) as session:
            ways = cell.bus.topic("left/planned_path", PathPreview)
            FakeArm(cell.bus, "left")
            now_s = 100.0
            board = RobotStatusCache(session, changed=lambda name: None, unix_s=lambda: now_s)
            await board.open()
            ways.publish(planned_path("left", "moving"))
            now_s = 107.0
            ways.publish(planned_path("left", "blocked", reason="a hand"))
            now_s = 109.0
            ways.publish(planned_path("left", "blocked", reason="an arm"))
            line = board.lines["left"].path
            assert line is not None
            assert (line.state, line.reason, line.since_s) == ("blocked", "an arm", 107.0)
            assert 1.0 < line.length_m < 1.5
            await cell.bus.call(SetSpeedOverride(share=0.25), to="left")
            assert board.lines["left"].path == line
            ways.publish(planned_path("left", "none"))
            assert board.lines["left"].path is None
            board.close()


async def test_what_says_the_same_again_wakes_nobody(tmp_path: Path) -> None:
    async with hub_of_two_arms(tmp_path) as (_, hub, arm):
        client = hub.join()
        client.frame()
        arm.become("idle")
        assert not client.dirty.is_set()
        hub.robots.close()
        arm.become("guiding")
        assert not client.dirty.is_set()


async def test_the_line_of_an_arm_says_how_monitoring_slows_it_down(tmp_path: Path) -> None:
    async with hub_of_two_arms(tmp_path) as (bus, hub, _):
        topic = bus.topic("left/separation", SeparationState)
        await hub.robots.open()
        client = hub.join()
        client.frame()

        def words(**state: object) -> str:
            topic.publish(msgspec.structs.replace(SeparationState(time_s=0.0, monitoring=True), **state))
            return delta(client).robots["left"].separation

        assert words(distance_m=0.72, permitted_share=0.4) == "slowed down: somebody at 0.7 m"
        assert words(distance_m=0.4, permitted_share=0.0) == "stopped: somebody at 0.4 m"
        assert words(permitted_share=0.0, reason="camera top is dark: light") == "stopped: camera top is dark: light"
        assert words(distance_m=2.0) == ""
