"""The devices of a simulated cell on the bus, and where what they move is for planners, cameras and frames."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from random import Random
from types import TracebackType
from typing import Self

import msgspec

from engine.bus import SkillBus
from engine.clock import Clock
from engine.document import Cell, LinearUnitSpec
from engine.errors import RobotError
from engine.messages import Pose
from engine.robot import DeviceStatus
from engine.skills.device_moves import DeviceFault, SimulateDeviceFault
from engine.skills.switch_result import SwitchResult
from robots.devices.device_server import DeviceMemo, DeviceServer, known_at
from robots.devices.hexapod_server import HexapodServer
from robots.devices.linear_unit_server import LinearUnitServer
from robots.devices.pins_of_simulation import PinFollower
from robots.devices.simulated_device import BRAKES, SimulatedDevice
from robots.model.transform import RigidTransform
from robots.port import GraspCommand
from robots.scene.sim_scene import SimScene
from robots.sim.world.sim_world import SimWorld

# A body that has moved by so much, in metres, is told to planners; frames follow what is smaller, too.
_MOVED_M, _FRAME_MOVED_M = 0.001, 2e-5
# How often platforms are looked at: an arm or a push moves them, and no device is told to.
_FOLLOW_S = 0.1


class _PortMemo(msgspec.Struct, frozen=True, kw_only=True):
    outputs: dict[str, bool]
    pressed: dict[str, float]
    air: bool
    power: bool = True
    stuck: tuple[str, ...]
    wrong: dict[str, bool]
    slipping: bool = False
    server: DeviceMemo


class SimulatedDevices:
    """All devices of one simulated world; entered, registered and left with it.

    Those on equipment are served by `EquippedDevices`, and moved by what the outputs of the equipment are.

    Args:
        cell: The cell.
        world: The world.
        clock: Its time.
    """

    name = "cell/devices"

    def __init__(self, cell: Cell, world: SimWorld, *, clock: Clock) -> None:
        self._world = world
        self._cell = cell.document
        self._clock = clock
        self._devices = cell.document.devices
        hexapods = {name: one.hexapod for name, one in self._devices.items() if one.hexapod is not None}
        platforms = {body: one.platform for one in hexapods.values() for body in one.carries}
        units = {name: one.linear_unit for name, one in self._devices.items() if one.linear_unit is not None}
        platforms |= {body: one.carriage for one in units.values() for body in one.carries}
        self._carriages = frozenset(body for one in units.values() for body in one.bodies)
        self._ports = {
            name: SimulatedDevice(device, world, platforms=platforms) for name, device in self._devices.items()
        }
        self._hexapods = [HexapodServer(name, one, pose_of=self._ports[name].pose) for name, one in hexapods.items()]
        self._units = [self._unit_server(name, unit) for name, unit in units.items()]
        self._servers = {
            name: DeviceServer(
                name, device, self._ports[name], clock=clock, is_at=self._is_at, moved=self._publish_poses
            )
            for name, device in self._devices.items()
            if device.equipment is None
        }
        self._pin_followers = tuple(
            PinFollower(
                equipment,
                tuple(self._ports[name] for name, device in self._devices.items() if device.equipment == equipment),
                simulated=cell.document.equipment[equipment].simulated,
                clock=clock,
            )
            for equipment in dict.fromkeys(device.equipment for device in self._devices.values())
            if equipment is not None
        )
        self._bus: SkillBus | None = None
        self._published: dict[str, Pose] = {}
        self._framed: dict[str, Pose] = {}
        self._stood: dict[str, Pose] = {}
        self._loose: frozenset[str] = frozenset()
        self._following: asyncio.Task[None] | None = None
        self.status = DeviceStatus.DISCONNECTED
        world.modules.watch(self._modules_changed)

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills of each device, and the service that breaks it."""
        self._bus = bus
        for served in (*self._servers.values(), *self._hexapods, *self._units):
            served.register(bus)
        for name, device in self._devices.items():
            if device.equipment is None or self._cell.equipment[device.equipment].simulated:
                bus.advertise_service(SimulateDeviceFault, self._fault_service(name), namespace=name)
        for follower in self._pin_followers:
            follower.start(bus)

    def grips(self) -> dict[str, GraspCommand]:
        """Return no grasp commands."""
        return {}

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Do nothing: devices have no grippers."""

    def memo(self) -> bytes:
        """Return outputs, faults and commands of all devices."""
        memos = {
            name: _PortMemo(
                outputs=port.outputs,
                pressed=port.pressed,
                air=port.air,
                power=port.power,
                stuck=tuple(sorted(port.stuck)),
                wrong=port.wrong,
                slipping=port.slipping,
                server=self._servers[name].memo if name in self._servers else DeviceMemo(),
            )
            for name, port in self._ports.items()
        }
        return msgspec.msgpack.encode(memos, order="deterministic")

    def remember(self, memo: bytes) -> None:
        """Restore them; raises RobotError for invalid bytes."""
        try:
            memos = msgspec.msgpack.decode(memo, type=dict[str, _PortMemo]) if memo else {}
        except msgspec.DecodeError as error:
            raise RobotError(f"the devices in the snapshot cannot be read: {error}", where=self.name) from error
        for name, known in memos.items():
            if name not in self._ports:
                continue
            port = self._ports[name]
            port.outputs, port.pressed, port.wrong = dict(known.outputs), dict(known.pressed), dict(known.wrong)
            port.air, port.power, port.stuck = known.air, known.power, set(known.stuck)
            port.slipping = known.slipping
            if name in self._servers:
                self._servers[name].memo = known.server
        for follower in self._pin_followers:
            follower.keep()
        self._drive()
        self._publish_poses()

    def world_lost(self, reason: str) -> None:
        """Do nothing: the port of the world says it."""

    def world_restored(self) -> None:
        """Press as before."""
        self._drive()
        self._publish_poses()

    async def stop(self) -> None:
        """End all sequences; outputs keep their values."""
        for server in self._servers.values():
            await server.stop()

    async def __aenter__(self) -> Self:
        self._drive()
        if self._hexapods or self._units or self._pin_followers:
            self._following = asyncio.create_task(self._follow(), name="following moved fixtures")
        self.status = DeviceStatus.READY
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.stop()
        for follower in self._pin_followers:
            await follower.close()
        if self._following is not None:
            self._following.cancel()
            await asyncio.wait([self._following])
        self.status = DeviceStatus.DISCONNECTED

    def _unit_server(self, name: str, unit: LinearUnitSpec) -> LinearUnitServer:
        world = self._world
        return LinearUnitServer(
            name,
            unit,
            home=self._cell.fixtures[unit.carriage].at.pose(),
            pose_of=self._ports[name].pose,
            arm=lambda: next(arm for arm in world.modules.scene.arms if arm.name == unit.robot),
            frames=world.modules.frames,
            noise=Random(f"{world.modules.scene.seed}/{name}/scale"),  # noqa: S311
        )

    def _drive(self) -> None:
        for port in self._ports.values():
            port.drive()

    def _is_at(self, device: str, position: str) -> bool:
        return self._bus is not None and known_at(self._bus, device, self._devices[device], position)

    def _modules_changed(self, _scene: SimScene) -> None:
        """Take note that moved fixtures are published where the cell document places them."""
        self._published, self._framed, self._stood = {}, {}, {}
        self._publish_poses()

    async def _follow(self) -> None:
        """Tell where platforms are that somebody moves, and axes whose pins somebody sets."""
        while True:
            await self._clock.sleep(_FOLLOW_S)
            if not self._world.lost_reason:
                self._publish_poses()

    def _publish_poses(self) -> None:
        """Tell planners and cameras where the moved fixtures are, and where the frames on them."""
        present = {
            body: port.pose(body)
            for port in self._ports.values()
            for body in port.bodies
            if self._world.modules.home_of(body) is not None
        }
        if _differ(present, self._framed, by_m=_FRAME_MOVED_M):
            self._framed = present
            self._world.modules.frames_moved(present)
        loose = frozenset(filter(None, (port.loose_carriage for port in self._ports.values())))
        carriages = {name: pose for name, pose in present.items() if name in self._carriages}
        # Planners know the base of an arm as exactly as frames.
        moved = _differ(present, self._published, by_m=_MOVED_M) or _differ(carriages, self._stood, by_m=_FRAME_MOVED_M)
        if moved or loose != self._loose:
            self._published, self._stood, self._loose = present, carriages, loose
            self._world.modules.fixtures_moved(present, loose=loose)

    def _fault_service(self, name: str) -> Callable[[SimulateDeviceFault], object]:
        async def break_device(request: SimulateDeviceFault) -> SwitchResult:
            port, device = self._ports[name], self._devices[name]
            fault = request.fault
            moving = [*device.axes, *device.belts, *((BRAKES,) if device.braked is not None else ())]
            for word, known in ((fault.stuck, moving), (fault.sensor, device.sensors)):
                if word and word not in known:
                    return SwitchResult(success=False, message=f"{name} has no {word}: it has {', '.join(known)}")
            if not fault.brakes and device.braked is None:
                return SwitchResult(success=False, message=f"{name} has no hexapod and no linear unit: no brakes")
            port.air, port.power = fault.air, fault.power
            port.stuck = {fault.stuck} if fault.stuck else set()
            port.wrong = {fault.sensor: fault.reads} if fault.sensor else {}
            port.slipping = not fault.brakes
            port.drive()
            if name in self._servers:
                self._servers[name].publish()
            words = "without a fault" if fault == DeviceFault() else "broken"
            return SwitchResult(success=True, message=f"{name} is {words}")

        return break_device


def _differ(present: Mapping[str, Pose], known: Mapping[str, Pose], *, by_m: float) -> bool:
    """Return whether a pose is new, or has moved by more than a distance, or ten times as many radians."""
    for name, pose in present.items():
        if name not in known:
            return True
        now, before = RigidTransform.from_pose(pose), RigidTransform.from_pose(known[name])
        if now.distance_m(before) > by_m or now.angle_rad(before) > 10.0 * by_m:
            return True
    return False
