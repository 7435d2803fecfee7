"""Where the items of a cell are, and what its tools hold, as pages hear of it."""

from __future__ import annotations

from dataclasses import dataclass

from editor_web.telemetry.data_frames import CellStateFrame, DataSubscription, DeviceNow, ToolHolds
from editor_web.telemetry.page_subscriptions import PageSubscriptions
from engine.bus import SkillBus
from engine.clock import LoopClock
from engine.messages import FramePoses, GripperState, PartPoses, Pose
from engine.messages.device_state import DeviceLink, DeviceState
from engine.messages.sensing import CameraInfo, CameraIntrinsics
from engine.project import BusInspector
from engine.skills.modules import MODULES_TOPIC, CellModules, ModuleState
from engine.skills.tool_changer import ToolChangerState
from tests.editor_web.fake_backend import FakeBackend

LENS = CameraIntrinsics(width_px=4, height_px=4, fx_px=2.0, fy_px=2.0, cx_px=1.5, cy_px=1.5)
EYE = CameraInfo(camera="eye", intrinsics=LENS, pose=Pose(xyz=(0.0, 0.0, 2.0)), rate_hz=10.0, range_m=(0.2, 5.0))


@dataclass
class Clock(LoopClock):
    """A clock that stands until it is set."""

    at_s: float = 0.0

    def now_s(self) -> float:
        return self.at_s


def state_of(page: PageSubscriptions) -> CellStateFrame | None:
    """Return the one frame that is due, if any."""
    frames = page.due()
    assert len(frames) <= 1
    frame = frames[0] if frames else None
    assert frame is None or isinstance(frame, CellStateFrame)
    return frame


async def test_poses_and_held_parts_are_sent_when_they_change() -> None:
    """Once in 0.2 s at most, and not again without a change that can be seen."""
    clock = Clock()
    async with SkillBus(clock) as bus:
        backend = FakeBackend()
        backend.known_inspector = BusInspector(bus)
        frames, parts = bus.topic("cell/frames", FramePoses), bus.topic("cell/parts", PartPoses)
        tool = bus.topic("left/gripper/state", GripperState)
        page = PageSubscriptions(backend)
        page.look(DataSubscription(cell=True))
        assert state_of(page) == CellStateFrame(poses={}, cameras={}, tools={})
        frames.publish(FramePoses(time_s=0.0, names=("left/tool",), xyz=((0.0, 0.0, 1.0),), xyzw=((0, 0, 0, 1),)))
        parts.publish(PartPoses(time_s=0.0, poses={"plate": Pose(xyz=(0.10000001, 0.0, 0.0))}))
        tool.publish(GripperState(time_s=0.0, width_m=0.04, force_n=9.0, held=True, part="plate"))
        bus.topic("eye/camera_info", CameraInfo).publish(EYE)
        assert state_of(page) is None
        clock.at_s = 0.3
        assert state_of(page) == CellStateFrame(
            poses={"left/tool": Pose(xyz=(0.0, 0.0, 1.0)), "plate": Pose(xyz=(0.1, 0.0, 0.0))},
            cameras={"eye": EYE.pose},
            tools={"left": ToolHolds(held=True, part="plate")},
        )
        parts.publish(PartPoses(time_s=0.1, poses={"plate": Pose(xyz=(0.10000002, 0.0, 0.0))}))
        clock.at_s = 0.6
        assert state_of(page) is None
        parts.publish(PartPoses(time_s=0.2, poses={"plate": Pose(xyz=(0.2, 0.0, 0.0))}))
        clock.at_s = 0.9
        moved = state_of(page)
        assert moved is not None
        assert moved.poses["plate"].xyz == (0.2, 0.0, 0.0)
        page.look(DataSubscription())
        clock.at_s = 1.2
        assert state_of(page) is None


async def test_real_devices_are_sent_with_how_fresh_their_readings_are() -> None:
    async with SkillBus(Clock()) as bus:
        backend = FakeBackend()
        backend.known_inspector = BusInspector(bus)
        state = DeviceState(driver="robotiq", address="here:1", connected=True, enabled=False, problem="not activated")
        link = DeviceLink(readings_hz=50.0, longest_gap_s=0.03, age_s=0.01)
        bus.topic("left/gripper/device", DeviceState).publish(state)
        bus.topic("left/gripper/link", DeviceLink).provide(lambda: link)
        bus.topic("right/device", DeviceState).publish(state)
        page = PageSubscriptions(backend)
        page.look(DataSubscription(cell=True))
        frame = state_of(page)
        assert frame is not None
        assert frame.devices == {
            "left/gripper": DeviceNow(state=state, link=link),
            "right": DeviceNow(state=state, link=None),
        }


async def test_modules_say_where_they_are_plugged() -> None:
    clock = Clock()
    async with SkillBus(clock) as bus:
        backend = FakeBackend()
        backend.known_inspector = BusInspector(bus)
        page = PageSubscriptions(backend)
        page.look(DataSubscription(cell=True))
        modules = (
            ModuleState(module="trolley", kind="cart"),
            ModuleState(module="rack", kind="rack", connector="east"),
        )
        bus.topic(MODULES_TOPIC, CellModules).publish(CellModules(modules=modules, free=("north",)))
        frame = state_of(page)
        assert frame is not None
        assert frame.modules == {"trolley": "", "rack": "east"}


async def test_the_tool_that_a_tool_changer_has_is_what_its_arm_holds() -> None:
    async with SkillBus(Clock()) as bus:
        backend = FakeBackend()
        backend.known_inspector = BusInspector(bus)
        bus.topic("arm/tool_changer", ToolChangerState).publish(ToolChangerState(tool="probe", lock="locked"))
        page = PageSubscriptions(backend)
        page.look(DataSubscription(cell=True))
        assert state_of(page) == CellStateFrame(poses={}, cameras={}, tools={"arm": ToolHolds(held=True, part="probe")})
