"""A workshop with taught entries, a Helping Hand and one described arm, for tests of proposals."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AsyncExitStack

from engine.bus import SkillBus
from engine.messages import PartPoses, Pose, RobotDescription
from engine.skills.gripper import GripperSetting
from engine.skills.motion import ForwardKinematics
from engine.store import Joints, SqliteStore, Value, register_store
from engine.teaching import HelpingHand
from tests.editor_web.workshop import Workshop

DOWN = (1.0, 0.0, 0.0, 0.0)
TAUGHT: dict[tuple[str, str], Value] = {
    ("joints", "home"): Joints(joints=(0.0, 0.5)),
    ("pose", "above_tray"): Pose(xyz=(0.4, 0.2, 0.3), xyzw=DOWN),
    ("pose", "tray_pick"): Pose(xyz=(0.4, 0.2, 0.1), xyzw=DOWN),
    ("pose", "bin"): Pose(xyz=(0.4, -0.2, 0.15), xyzw=DOWN),
    ("gripper", "around_gear"): GripperSetting(width_m=0.032, held=True, force_n=18.0),
    ("record", "tray"): {"rows": 4},
}
GEAR_M = (0.4, 0.2, 0.1)


def furnish(bus: SkillBus) -> None:
    """Put the arm and the part on the bus."""
    described = RobotDescription(
        name="arm", model="panda", urdf="", joint_names=("a", "b"), lower_rad=(-1.0, -1.0), upper_rad=(1.0, 1.0),
        velocity_rad_s=(1.0, 1.0), acceleration_rad_s2=(1.0, 1.0), base=Pose(xyz=(0.0, 0.0, 0.0)), tool_frame="tcp",
        tool="panda_hand", tool_kind="parallel",
    )  # fmt: skip
    bus.topic("arm/description", RobotDescription).publish(described)
    gear = Pose(xyz=GEAR_M)
    bus.topic("cell/parts", PartPoses).publish(PartPoses(time_s=0.0, poses={"gear": gear, "lid": Pose(xyz=(1, 1, 0))}))

    async def tool_at(request: ForwardKinematics) -> Pose:
        return Pose(xyz=(0.3, request.joints[0], 0.5), xyzw=DOWN)

    bus.advertise_service(ForwardKinematics, tool_at, namespace="arm")


def teach(shop: Workshop) -> Callable[[], None]:
    """Open store and Helping Hand on the bus of a workshop; returns what closes them."""
    opened = AsyncExitStack()

    async def up() -> None:
        bus = shop.session.cell.bus
        store = await opened.enter_async_context(SqliteStore.open(":memory:", inline=True))
        for (kind, name), value in TAUGHT.items():
            await store.put(kind, name, value)
        register_store(bus, store)
        await opened.enter_async_context(HelpingHand(bus, robots=("arm",)))

    shop.call(up())
    return lambda: shop.call(opened.aclose())
