"""Devices of a cell or module: what moves by valves, the positions it has, and what is known of them.

A vice, a clamp, a slide or a lamp is described here and needs no code of its own. Outputs are on or off; an axis moves
a fixture by the air of a valve. Lengths are in metres, angles in radians, forces in newton, torques in newton metres.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Annotated

from msgspec import Meta
from msgspec.structs import replace

from engine.document.cell_bodies import Fixture
from engine.document.cell_bonds import BondKind
from engine.document.duration import Duration
from engine.document.hexapods.hexapod_spec import HexapodSpec, placed_hexapod
from engine.document.linear_units.linear_unit_spec import LinearUnitSpec
from engine.document.placement import Name, PositionXyz
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.messages import Vector3
from engine.wording import did_you_mean

LONGEST_TURN_RAD = 5.5
"""The stroke of a hinge; beyond it, its two ends could not be told apart by its pose."""


class _Axis(StrictModel, frozen=True, kw_only=True, tag_field="joint"):
    """A fixture on a pneumatic cylinder: 0 where the document places it, its stroke at its other end.

    With `output` on, its air presses it to its stroke, else back to 0. With an `output_back` too, it is pressed by
    the one that is on; with none on, the valve is in its middle position and vents. Its speed is that of the free
    axis, its force or torque what it presses with at rest. Without air a `self_holding` axis, one with a toggle or a
    check valve, keeps its place and its force; any other lets go.
    """

    body: Annotated[str, Meta(min_length=1, description="The fixture that moves")]
    along: Annotated[Vector3, Meta(description="Direction of the slide, or axis of the hinge, in the fixture's frame")]
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass of what moves")] = 0.5
    friction: Annotated[float, Meta(gt=0.0, le=2.0, description="Coefficient of friction of what presses")] = 0.5
    against: Annotated[tuple[str, ...], Meta(description="Fixtures with the same surface, such as a fixed jaw")] = ()
    self_holding: bool = False
    cuts: Annotated[tuple[BondKind, ...], Meta(description="Kinds of bonds that its fixture, a blade, cuts")] = ()
    output: Name
    output_back: Name | None = None


class SlideAxis(_Axis, frozen=True, kw_only=True, tag="slide"):
    """An axis that slides."""

    stroke_m: Annotated[float, Meta(gt=0.0, description="The other end of the axis in metres; 0 is the first")]
    force_n: Annotated[float, Meta(gt=0.0, le=1e5, description="Force at rest in newton")]
    speed_m_s: Annotated[float, Meta(gt=0.0, le=10.0, description="Speed of the free axis in m/s")]


class HingeAxis(_Axis, frozen=True, kw_only=True, tag="hinge"):
    """An axis that turns."""

    stroke_rad: Annotated[
        float, Meta(gt=0.0, le=LONGEST_TURN_RAD, description="The other end of the axis in radians; 0 is the first")
    ]
    torque_nm: Annotated[float, Meta(gt=0.0, le=1e5, description="Torque at rest in newton metres")]
    speed_rad_s: Annotated[float, Meta(gt=0.0, le=10.0, description="Speed of the free axis in rad/s")]


DeviceAxis = SlideAxis | HingeAxis


class DeviceBelt(StrictModel, frozen=True, kw_only=True):
    """A conveyor belt: the surface of a fixture runs, and carries what lies on it by friction.

    It runs while `output` is on, or back while `output_back` is; its surface changes speed by its acceleration.
    """

    body: Annotated[str, Meta(min_length=1, description="The fixture whose surface runs, a box")]
    along: Annotated[Vector3, Meta(description="Direction in which it runs, in the fixture's frame")]
    speed_m_s: Annotated[float, Meta(gt=0.0, le=5.0, description="Speed of the running belt in m/s")]
    acceleration_m_s2: Annotated[float, Meta(gt=0.0, le=50.0, description="How it changes speed, in m/s²")] = 2.0
    friction: Annotated[float, Meta(gt=0.0, le=2.0, description="Coefficient of friction of the belt")] = 0.7
    output: Name
    output_back: Name | None = None


class LightBarrier(StrictModel, frozen=True, kw_only=True):
    """A beam between two points in the frame of a fixture."""

    body: Annotated[str, Meta(min_length=1, description="The fixture in whose frame the points are")]
    start_m: PositionXyz
    end_m: PositionXyz


class DeviceSensor(StrictModel, frozen=True, kw_only=True):
    """A switch: on while its axis is within the limits, while there is air (`air: true`), or while a part is in a beam.

    The limits are in metres for an axis that slides, in radians for one that turns.
    """

    axis: Name | None = None
    at_least: float | None = None
    at_most: float | None = None
    air: bool = False
    beam: LightBarrier | None = None

    def is_on(self, place: float) -> bool:
        """Return whether it is on at a place of its axis."""
        return (self.at_least is None or place >= self.at_least) and (self.at_most is None or place <= self.at_most)


class DeviceStep(StrictModel, frozen=True, kw_only=True):
    """One step towards a position: outputs are set, a time passes, or sensors are awaited for at most `within`."""

    set: dict[Name, bool] | None = None
    pause: Duration | None = None
    wait_for: dict[Name, bool] | None = None
    within: Duration = 2.0

    @property
    def kinds(self) -> tuple[str, ...]:
        """What of the three it does; a valid step does one."""
        return tuple(kind for kind in ("set", "pause", "wait_for") if getattr(self, kind) is not None)


class DevicePosition(StrictModel, frozen=True, kw_only=True):
    """A position by name: its steps, and then the sensors that tell it, or the time after which it is assumed.

    Without `sensors` nothing tells that it is reached: the state says `unknown`.
    """

    steps: Annotated[tuple[DeviceStep, ...], Meta(min_length=1)]
    sensors: Annotated[dict[Name, bool], Meta(description="Values of the sensors there")] = {}
    stable: Annotated[Duration, Meta(description="How long the sensors must say so: longer than passing takes")] = 0.0
    time: Annotated[Duration, Meta(description="Time after the last step until it is assumed, or missed by sensors")]


class DeviceInterlock(StrictModel, frozen=True, kw_only=True):
    """A position that is left alone unless another device is at one of its own."""

    position: Name
    device: Annotated[str, Meta(min_length=1, description="The other device")]
    at: Annotated[Name, Meta(description="Its position; sensed where it has sensors for it, else commanded and timed")]


class DeviceSpec(StrictModel, frozen=True, kw_only=True):
    """A device: its axes, belts, sensors, positions and interlocks. One that moves nothing switches outputs: a lamp.

    With `equipment`, its outputs and sensors are the pins of that equipment with the same names. A module does not name
    equipment: the cell does that for all devices of the module.
    With a `hexapod` it has the brakes of a passive platform, and the axes on it, such as clamps. With a `linear_unit`
    it has those of the carriage on which a robot of the cell stands.
    """

    description: str = ""
    equipment: Annotated[Name | None, Meta(description="Equipment of the cell on whose pins it is")] = None
    axes: dict[Name, DeviceAxis] = {}
    hexapod: HexapodSpec | None = None
    linear_unit: LinearUnitSpec | None = None
    belts: dict[Name, DeviceBelt] = {}
    sensors: dict[Name, DeviceSensor] = {}
    positions: Annotated[dict[Name, DevicePosition], Meta(min_length=1)]
    interlocks: tuple[DeviceInterlock, ...] = ()

    @property
    def outputs(self) -> tuple[str, ...]:
        """The outputs that its steps set, in their order."""
        steps = (step for position in self.positions.values() for step in position.steps)
        return tuple(dict.fromkeys(name for step in steps for name in step.set or {}))

    @property
    def moved_fixtures(self) -> tuple[str, ...]:
        """The fixtures that move with it: those of its axes, and platform or carriage with what that carries."""
        axes = tuple(axis.body for axis in self.axes.values())
        return (*axes, *(self.braked.bodies if self.braked is not None else ()))

    @property
    def braked(self) -> HexapodSpec | LinearUnitSpec | None:
        """What its brakes hold, None without brakes."""
        return self.hexapod if self.hexapod is not None else self.linear_unit

    @property
    def air_sensor(self) -> str:
        """The pressure switch, empty for none: then lost air is not noticed as such."""
        return next((name for name, sensor in self.sensors.items() if sensor.air), "")


def placed_device(device: DeviceSpec, named: Callable[[str], str], *, equipment: str | None) -> DeviceSpec:
    """Return a device of a module whose fixtures and other devices have their names in the cell."""
    axes = {
        name: replace(axis, body=named(axis.body), against=tuple(named(one) for one in axis.against))
        for name, axis in device.axes.items()
    }
    belts = {name: replace(belt, body=named(belt.body)) for name, belt in device.belts.items()}
    sensors = {
        name: replace(one, beam=replace(one.beam, body=named(one.beam.body)) if one.beam is not None else None)
        for name, one in device.sensors.items()
    }
    interlocks = tuple(replace(one, device=named(one.device)) for one in device.interlocks)
    hexapod = placed_hexapod(device.hexapod, named) if device.hexapod is not None else None
    return replace(
        device,
        axes=axes,
        hexapod=hexapod,
        belts=belts,
        sensors=sensors,
        interlocks=interlocks,
        equipment=equipment,
    )


def require_devices(
    devices: Mapping[str, DeviceSpec],
    source: DocumentSource,
    *,
    fixtures: Mapping[str, Fixture],
    taken: Mapping[str, str] | None = None,
) -> None:
    """Require that all names in devices lead somewhere, and that no fixture is moved twice.

    `taken` are the names of what else is on the bus, with what it is.

    Raises:
        DocumentError: `where` is the position in the document.
    """
    moved: dict[str, str] = {}
    for name, device in devices.items():
        if taken is not None and name in taken:
            where = source.position(("devices", name), of_key=True)
            raise DocumentError(f"`{name}` is both a device and a {taken[name]}", where=where, hint="rename one")
        for path, message, hint in (
            *_axis_problems(name, device, fixtures, moved),
            *_belt_problems(name, device, fixtures, moved),
            *_sensor_problems(device, fixtures),
            *_position_problems(name, device),
            *_interlock_problems(name, device, devices),
        ):
            raise DocumentError(message, where=source.position(("devices", name, *path)), hint=hint)


_Problem = tuple[DataPath, str, str]


def _axis_problems(
    name: str, device: DeviceSpec, fixtures: Mapping[str, Fixture], moved: dict[str, str]
) -> Iterator[_Problem]:
    for key, axis in device.axes.items():
        path = ("axes", key)
        for where, body in (((*path, "body"), axis.body), *(((*path, "against"), one) for one in axis.against)):
            if body not in fixtures:
                yield where, f"there is no fixture `{body}`", did_you_mean(body, fixtures)
        body = axis.body
        if body in moved:
            yield (*path, "body"), f"`{body}` is moved by {moved[body]} too", "give each axis a fixture of its own"
        moved[body] = f"`{key}` of `{name}`"
        if body in fixtures and (fixtures[body].spring is not None or fixtures[body].shape in {"tray", "mesh"}):
            yield (*path, "body"), f"`{body}` cannot be moved by an axis", "choose a box or cylinder without a spring"
        if math.hypot(*axis.along) < 1e-6:
            yield (*path, "along"), "this direction has no length", "[1, 0, 0] is along the x axis of the fixture"
        yield from _output_problems(axis, path, device)


def _belt_problems(
    name: str, device: DeviceSpec, fixtures: Mapping[str, Fixture], moved: dict[str, str]
) -> Iterator[_Problem]:
    for key, belt in device.belts.items():
        path, body = ("belts", key), belt.body
        if body not in fixtures:
            yield (*path, "body"), f"there is no fixture `{body}`", did_you_mean(body, fixtures)
        elif fixtures[body].spring is not None or fixtures[body].shape != "box":
            yield (*path, "body"), f"`{body}` cannot be a belt", "choose a box without a spring"
        if body in moved:
            yield (*path, "body"), f"`{body}` is moved by {moved[body]} too", "give each belt a fixture of its own"
        moved[body] = f"`{key}` of `{name}`"
        if math.hypot(*belt.along) < 1e-6:
            yield (*path, "along"), "this direction has no length", "[1, 0, 0] is along the x axis of the fixture"
        yield from _output_problems(belt, path, device)


def _output_problems(moving: DeviceAxis | DeviceBelt, path: DataPath, device: DeviceSpec) -> Iterator[_Problem]:
    for output in (moving.output, moving.output_back):
        if output is not None and output not in device.outputs:
            field = "output" if output == moving.output else "output_back"
            yield (*path, field), f"no step sets the output `{output}`", did_you_mean(output, device.outputs)


def _sensor_problems(device: DeviceSpec, fixtures: Mapping[str, Fixture]) -> Iterator[_Problem]:
    for key, sensor in device.sensors.items():
        path = ("sensors", key)
        if sensor.air + (sensor.axis is not None) + (sensor.beam is not None) != 1:
            yield path, f"sensor `{key}` has either an `axis`, a `beam` or `air: true`", "set one of them"
        if sensor.beam is not None and sensor.beam.body not in fixtures:
            body = sensor.beam.body
            yield (*path, "beam", "body"), f"there is no fixture `{body}`", did_you_mean(body, fixtures)
        if sensor.axis is not None and sensor.axis not in device.axes:
            yield (*path, "axis"), f"there is no axis `{sensor.axis}`", did_you_mean(sensor.axis, device.axes)
        if sensor.at_least is not None and sensor.at_most is not None and sensor.at_least > sensor.at_most:
            yield path, f"sensor `{key}` is never on", "`at_least` is at most `at_most`"


def _position_problems(_name: str, device: DeviceSpec) -> Iterator[_Problem]:
    for key, position in device.positions.items():
        path = ("positions", key)
        for index, step in enumerate(position.steps):
            if len(step.kinds) != 1:
                yield (*path, "steps", index), "a step has one of `set`, `pause`, `wait_for`", "split it into steps"
            for sensor in step.wait_for or {}:
                if sensor not in device.sensors:
                    where = (*path, "steps", index, "wait_for")
                    yield where, f"there is no sensor `{sensor}`", did_you_mean(sensor, device.sensors)
        for sensor in position.sensors:
            if sensor not in device.sensors:
                where = (*path, "sensors")
                yield where, f"there is no sensor `{sensor}`", did_you_mean(sensor, device.sensors)


def _interlock_problems(name: str, device: DeviceSpec, devices: Mapping[str, DeviceSpec]) -> Iterator[_Problem]:
    for index, lock in enumerate(device.interlocks):
        path = ("interlocks", index)
        if lock.position not in device.positions:
            hint = did_you_mean(lock.position, device.positions)
            yield (*path, "position"), f"`{name}` has no position `{lock.position}`", hint
        other = devices.get(lock.device)
        if other is None:
            yield (*path, "device"), f"there is no device `{lock.device}`", did_you_mean(lock.device, devices)
        elif lock.at not in other.positions:
            yield (*path, "at"), f"`{lock.device}` has no position `{lock.at}`", did_you_mean(lock.at, other.positions)
