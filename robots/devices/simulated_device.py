"""One device of a simulated cell: its valves, air and faults, and the sensors that follow the physics."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from engine.bus import Holder
from engine.document import DeviceAxis, DeviceSensor, DeviceSpec, LightBarrier, LinearUnitSpec, SlideAxis
from engine.errors import RobotError
from engine.messages import Pose
from robots.devices.light_barrier import is_interrupted
from robots.model.transform import RigidTransform
from robots.sim.commands.world_commands import BrakeCarriage, BrakeLegs, DriveAxis
from robots.sim.world.sim_world import SimWorld

BRAKES = "brakes"
"""What is `stuck` where brakes stay closed whatever their output is."""
_BEFORE_RAD = 0.5


class SimulatedDevice:
    """Implements `DevicePort` on a simulated world; `air`, `power`, `stuck`, `wrong`, `slipping` brakes are its faults.

    Args:
        device: The device as written.
        world: The world.
        platforms: The platform on which fixtures of the cell stand, by their names.
    """

    def __init__(self, device: DeviceSpec, world: SimWorld, *, platforms: Mapping[str, str]) -> None:
        self._device = device
        self._world = world
        self._platforms = platforms
        self.slipping = False
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
        braked = self._device.braked
        if braked is None:
            return
        is_loose = self.released or self.slipping
        force = braked.friction_n if is_loose else braked.holding_n
        if isinstance(braked, LinearUnitSpec):
            self._world.host.send(BrakeCarriage(carriage=braked.carriage, force_n=force, released=is_loose))
        else:
            self._world.host.send(BrakeLegs(platform=braked.platform, force_n=force))

    @property
    def released(self) -> bool:
        """Whether its brakes are released: they are closed by springs, and opened by air unless they are stuck."""
        braked = self._device.braked
        return braked is not None and self.air and BRAKES not in self.stuck and self.outputs[braked.brakes]

    @property
    def loose_carriage(self) -> str:
        """The carriage of its linear unit while that is meant to move, empty else."""
        unit = self._device.linear_unit
        return unit.carriage if unit is not None and self.outputs[unit.brakes] else ""

    @property
    def bodies(self) -> tuple[str, ...]:
        """The fixtures that it moves."""
        return self._device.moved_fixtures

    def pose(self, body: str) -> Pose:
        """Return the pose of a fixture in the world; raises RobotError where its module is not plugged."""
        home = self._world.modules.home_of(body)
        if home is None:
            raise RobotError(f"{body} is not in the cell", hint="plug its module first")
        names = self._world.host.summary.frames
        if body not in names:
            return home
        xyz, xyzw = self._world.measured().frames()
        row = names.index(body)
        return Pose(xyz=xyz[row], xyzw=xyzw[row])

    def _place(self, axis: DeviceAxis) -> float:
        now = RigidTransform.from_pose(self.pose(axis.body))
        home = self._home(axis.body)
        platform = self._platforms.get(axis.body)
        if platform is not None:
            now = RigidTransform.from_pose(self.pose(platform)).inverse().then(now)
            home = self._home(platform).inverse().then(home)
        moved = home.inverse().then(now)
        along = np.array(axis.along) / np.linalg.norm(axis.along)
        if isinstance(axis, SlideAxis):
            return float(moved.xyz @ along)
        angle = float(2.0 * np.arctan2(moved.xyzw[:3] @ along, moved.xyzw[3]))
        # From a little before 0 on: an axis rests a little before its end.
        return (angle + _BEFORE_RAD) % (2.0 * np.pi) - _BEFORE_RAD

    def _home(self, body: str) -> RigidTransform:
        home = self._world.modules.home_of(body)
        assert home is not None
        return RigidTransform.from_pose(home)


def _direction(axis: DeviceAxis, outputs: Mapping[str, bool]) -> float:
    """Return whether air presses an axis to its stroke, 1, back, -1, or not at all, 0."""
    if axis.output_back is None:
        return 1.0 if outputs[axis.output] else -1.0
    return float(outputs[axis.output]) - float(outputs[axis.output_back])
