"""The devices of a simulated cell: their valves, air and faults, and the sensors that follow the physics."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Self

import msgspec
import numpy as np

from engine.bus import Holder, SkillBus
from engine.clock import Clock
from engine.document import Cell, DeviceAxis, DeviceSensor, DeviceSpec, LightBarrier, SlideAxis
from engine.errors import RobotError
from engine.messages import Pose
from engine.robot import DeviceStatus
from engine.skills.device_moves import DeviceFault, DeviceReading, SimulateDeviceFault
from engine.skills.switch_result import SwitchResult
from robots.devices.device_server import DeviceMemo, DeviceServer, known_at
from robots.devices.light_barrier import is_interrupted
from robots.devices.pins_of_simulation import SimulatedWiring
from robots.model.transform import RigidTransform
from robots.port import GraspCommand
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import DriveAxis
from robots.sim.world.sim_world import SimWorld

# A body that has moved by so much, in metres, is told to planners.
_MOVED_M = 0.001
_BEFORE_RAD = 0.5


class _PortMemo(msgspec.Struct, frozen=True, kw_only=True):
    outputs: dict[str, bool]
    pressed: dict[str, float]
    air: bool
    power: bool = True
    stuck: tuple[str, ...]
    wrong: dict[str, bool]
    server: DeviceMemo


class SimulatedDevice:
    """Implements `DevicePort` on a simulated world; `air`, `power`, `stuck` and `wrong` are its faults."""

    def __init__(self, device: DeviceSpec, world: SimWorld) -> None:
        self._device = device
        self._world = world
        self.outputs: dict[str, bool] = dict.fromkeys(device.outputs, False)
        self.pressed: dict[str, float] = dict.fromkeys(device.axes, 0.0)
        self.air = self.power = True
        self.stuck: set[str] = set()
        self.wrong: dict[str, bool] = {}

    async def set_output(self, name: str, *, on: bool, holder: Holder) -> None:
        """Turn an output on or off from the next step on."""
        del holder
        self.take_outputs({name: on})

    def take_outputs(self, values: Mapping[str, bool]) -> None:
        """Have outputs from the next step on; names of others are left out."""
        self.outputs |= {name: on for name, on in values.items() if name in self.outputs}
        self.drive()

    @property
    def axes(self) -> Mapping[str, float]:
        """The places of the axes in the world, in m or rad."""
        return {name: self._place(axis) for name, axis in self._device.axes.items()}

    @property
    def sensors(self) -> Mapping[str, bool]:
        """What the sensors say."""
        axes = self.axes
        return {name: self._reads(sensor, axes) for name, sensor in self._device.sensors.items()} | self.wrong

    def _reads(self, sensor: DeviceSensor, axes: Mapping[str, float]) -> bool:
        if sensor.beam is not None:
            return self._is_interrupted(sensor.beam)
        return self.air if sensor.axis is None else sensor.is_on(axes[sensor.axis])

    def _is_interrupted(self, beam: LightBarrier) -> bool:
        home, scene = self._world.modules.home_of(beam.body), self._world.modules.scene
        if home is None:
            return False
        measured = self._world.measured()
        poses = [(part, RigidTransform.of(*measured.frame(part.name))) for part in (*scene.parts, *scene.unknown_parts)]
        return is_interrupted(beam, RigidTransform.from_pose(home), poses)

    def drive(self) -> None:
        """Send what presses each axis to the world."""
        for name, axis in self._device.axes.items():
            if self.air:
                self.pressed[name] = _direction(axis, self.outputs)
            elif not axis.self_holding:
                self.pressed[name] = 0.0
            locked = name in self.stuck
            force = 0.0 if locked else self.pressed[name]
            self._world.host.send(DriveAxis(fixture=axis.body, direction=force, locked=locked))
        for name, belt in self._device.belts.items():
            back = self.outputs[belt.output_back] if belt.output_back is not None else False
            runs = (float(self.outputs[belt.output]) - float(back)) * self.power
            self._world.host.send(DriveAxis(fixture=belt.body, direction=runs, locked=name in self.stuck))

    def pose(self, axis: DeviceAxis) -> Pose:
        """Return the pose of a moved fixture in the world."""
        xyz, xyzw = self._world.measured().frames()
        row = self._world.host.summary.frames.index(axis.body)
        return Pose(xyz=xyz[row], xyzw=xyzw[row])

    def _place(self, axis: DeviceAxis) -> float:
        home = self._world.modules.home_of(axis.body)
        if home is None:
            raise RobotError(f"{axis.body} is not in the cell", hint="plug its module first")
        moved = RigidTransform.from_pose(home).inverse().then(RigidTransform.from_pose(self.pose(axis)))
        along = np.array(axis.along) / np.linalg.norm(axis.along)
        if isinstance(axis, SlideAxis):
            return float(moved.xyz @ along)
        angle = float(2.0 * np.arctan2(moved.xyzw[:3] @ along, moved.xyzw[3]))
        # From a little before 0 on: an axis rests a little before its end.
        return (angle + _BEFORE_RAD) % (2.0 * np.pi) - _BEFORE_RAD


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
        self._devices = cell.document.devices
        self._ports = {name: SimulatedDevice(device, world) for name, device in self._devices.items()}
        self._servers = {
            name: DeviceServer(
                name, device, self._ports[name], clock=clock, is_at=self._is_at, moved=self._publish_poses
            )
            for name, device in self._devices.items()
            if device.equipment is None
        }
        self._wirings = tuple(
            SimulatedWiring(
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
        self.status = DeviceStatus.DISCONNECTED
        world.modules.watch(self._modules_changed)

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills of each device, and the service that breaks it."""
        self._bus = bus
        for server in self._servers.values():
            server.register(bus)
        for name, device in self._devices.items():
            if device.equipment is None or self._cell.equipment[device.equipment].simulated:
                bus.advertise_service(SimulateDeviceFault, self._fault_service(name), namespace=name)
            if device.equipment is not None:
                # While it is moved it publishes its state, and at rest its last one.
                bus.topic(f"{name}/state", DeviceReading).subscribe(lambda _state: self._publish_poses())
        for wiring in self._wirings:
            wiring.start(bus)

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
            if name in self._servers:
                self._servers[name].memo = known.server
        for wiring in self._wirings:
            wiring.keep()
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
        self.status = DeviceStatus.READY
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.stop()
        for wiring in self._wirings:
            await wiring.close()
        self.status = DeviceStatus.DISCONNECTED

    def _drive(self) -> None:
        for port in self._ports.values():
            port.drive()

    def _is_at(self, device: str, position: str) -> bool:
        return self._bus is not None and known_at(self._bus, device, self._devices[device], position)

    def _modules_changed(self, _scene: SimScene) -> None:
        """Take note that moved fixtures are published where the cell document places them."""
        self._published = {}
        self._publish_poses()

    def _publish_poses(self) -> None:
        """Tell planners and cameras where the moved fixtures are."""
        present = {
            axis.body: port.pose(axis)
            for name, port in self._ports.items()
            for axis in self._devices[name].axes.values()
            if self._world.modules.home_of(axis.body) is not None
        }
        if any(name not in self._published or _differ(pose, self._published[name]) for name, pose in present.items()):
            self._published = present
            self._world.modules.fixtures_moved(present)

    def _fault_service(self, name: str) -> Callable[[SimulateDeviceFault], object]:
        async def break_device(request: SimulateDeviceFault) -> SwitchResult:
            port, device = self._ports[name], self._devices[name]
            fault = request.fault
            moving = {**device.axes, **device.belts}
            for word, known in ((fault.stuck, moving), (fault.sensor, device.sensors)):
                if word and word not in known:
                    return SwitchResult(success=False, message=f"{name} has no {word}: it has {', '.join(known)}")
            port.air, port.power = fault.air, fault.power
            port.stuck = {fault.stuck} if fault.stuck else set()
            port.wrong = {fault.sensor: fault.reads} if fault.sensor else {}
            port.drive()
            if name in self._servers:
                self._servers[name].publish()
            words = "without a fault" if fault == DeviceFault() else "broken"
            return SwitchResult(success=True, message=f"{name} is {words}")

        return break_device


def _direction(axis: DeviceAxis, outputs: Mapping[str, bool]) -> float:
    """Return whether air presses an axis to its stroke, 1, back, -1, or not at all, 0."""
    if axis.output_back is None:
        return 1.0 if outputs[axis.output] else -1.0
    return float(outputs[axis.output]) - float(outputs[axis.output_back])


def _differ(one: Pose, other: Pose) -> bool:
    first, second = RigidTransform.from_pose(one), RigidTransform.from_pose(other)
    return first.distance_m(second) > _MOVED_M or first.angle_rad(second) > 10.0 * _MOVED_M
