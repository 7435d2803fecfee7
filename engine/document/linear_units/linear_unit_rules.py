"""What a document may say of linear units: names that lead somewhere, a level rail, and places within its travel."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain

from engine.document.cell_bodies import Fixture
from engine.document.cell_devices import DeviceSpec
from engine.document.cell_frames import FrameSpec, poses_in_world, stands_on
from engine.document.linear_units.linear_unit_spec import LinearUnitSpec
from engine.document.robot_spec import RobotSpec
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.messages import Pose
from engine.wording import did_you_mean

_Problem = tuple[DataPath, str, str]
_LEVEL_RAD = 0.002


def require_linear_units(
    devices: Mapping[str, DeviceSpec],
    source: DocumentSource,
    *,
    robots: Mapping[str, RobotSpec],
    fixtures: Mapping[str, Fixture],
    frames: Mapping[str, FrameSpec],
    uses: Iterable[tuple[DataPath, str]],
) -> None:
    """Require linear units that can be built, whose robots stand on them and whose places are within their travel.

    Frames and fixtures lead to the world, as `require_frames` requires; `uses` says in which frames the rest stands.

    Raises:
        DocumentError: `where` is the position in the document.
    """
    units = {name: device.linear_unit for name, device in devices.items() if device.linear_unit is not None}
    if not units:
        return
    poses, used_frames = poses_in_world(frames, fixtures), tuple(uses)
    cameras = [path for path, _ in used_frames if path[0] == "cameras"]
    for name, unit in units.items():
        path: DataPath = ("devices", name, "linear_unit")
        # One after the other: each set of rules counts on those before it.
        for inner, message, hint in chain(
            _name_problems(unit, devices[name], robots, fixtures, frames),
            _robot_problems(unit, robots.get(unit.robot), fixtures, frames, units, name),
            _body_problems(name, unit, devices, fixtures, frames),
            _place_problems(unit, poses),
        ):
            raise DocumentError(message, where=source.position((*path, *inner)), hint=hint)
        if cameras:
            raise DocumentError(
                f"`{name}` moves a robot, and the cell has cameras: they would take it for something unknown",
                where=source.position(path),
                hint="remove the cameras: what they see of a robot whose base moves is not told from other things yet",
            )
        for used, frame in used_frames:
            own = used[:2] == ("robots", unit.robot)
            if used[0] in ("parts", "unknown_bodies") or own or not stands_on(frame, unit.carriage, fixtures, frames):
                continue
            raise DocumentError(
                f"`{used[1]}` stands on the carriage of `{name}`, which moves",
                where=source.position(used),
                hint=f"only `{unit.robot}`, fixtures, frames and parts stand on it: place it elsewhere",
            )


def refuse_linear_units(devices: Mapping[str, DeviceSpec], source: DocumentSource) -> None:
    """Refuse linear units in a module, which knows no robot; raises DocumentError with its position."""
    for name, device in devices.items():
        if device.linear_unit is not None:
            raise DocumentError(
                f"the device `{name}` of a module has a linear unit, but a module has no robot",
                where=source.position(("devices", name, "linear_unit")),
                hint="write the device in the cell document, where the robot is",
            )


def _name_problems(
    unit: LinearUnitSpec,
    device: DeviceSpec,
    robots: Mapping[str, RobotSpec],
    fixtures: Mapping[str, Fixture],
    frames: Mapping[str, FrameSpec],
) -> Iterator[_Problem]:
    if unit.robot not in robots:
        yield ("robot",), f"there is no robot `{unit.robot}`", did_you_mean(unit.robot, robots)
    named: list[tuple[DataPath, str]] = [(("carriage",), unit.carriage)]
    named += [(("carries", index), one) for index, one in enumerate(unit.carries)]
    for path, fixture in named:
        if fixture not in fixtures:
            yield path, f"there is no fixture `{fixture}`", did_you_mean(fixture, fixtures)
    for name, frame in unit.anchors.items():
        if frame not in frames:
            yield ("anchors", name), f"there is no frame `{frame}`", did_you_mean(frame, frames)
        elif stands_on(frame, unit.carriage, fixtures, frames):
            yield ("anchors", name), f"`{frame}` stands on the carriage itself", "an anchor stands beside the rail"
    if unit.brakes not in device.outputs:
        yield ("brakes",), f"no step sets the output `{unit.brakes}`", did_you_mean(unit.brakes, device.outputs)
    for field, position in (("released", unit.released), ("locked", unit.locked)):
        if position not in device.positions:
            hint = did_you_mean(position, device.positions)
            yield (field,), f"the device has no position `{position}` for its brakes", hint
    if device.hexapod is not None:
        yield (), "a device has a hexapod or a linear unit, not both", "make two devices of it"


def _robot_problems(
    unit: LinearUnitSpec,
    robot: RobotSpec | None,
    fixtures: Mapping[str, Fixture],
    frames: Mapping[str, FrameSpec],
    units: Mapping[str, LinearUnitSpec],
    name: str,
) -> Iterator[_Problem]:
    if robot is None:
        return
    if not stands_on(robot.base.frame, unit.carriage, fixtures, frames):
        hint = f"give it `base: {{frame: {unit.carriage}}}`"
        yield ("robot",), f"`{unit.robot}` does not stand on `{unit.carriage}`", hint
    if not robot.simulated:
        hint = "use `driver: sim`: nobody tells where a real carriage is yet"
        yield ("robot",), f"`{unit.robot}` has a driver, and its base cannot move", hint
    other = next((one for one, each in units.items() if one != name and each.robot == unit.robot), "")
    if other:
        yield ("robot",), f"`{unit.robot}` stands on `{other}` too", "a robot stands on one carriage"


def _body_problems(
    name: str,
    unit: LinearUnitSpec,
    devices: Mapping[str, DeviceSpec],
    fixtures: Mapping[str, Fixture],
    frames: Mapping[str, FrameSpec],
) -> Iterator[_Problem]:
    for path, body in ((("carriage",), unit.carriage), *((("carries", i), one) for i, one in enumerate(unit.carries))):
        if fixtures[body].spring is not None:
            yield path, f"`{body}` has a spring and cannot be moved", "remove the spring"
        for other, device in devices.items():
            if body in device.moved_fixtures and (other != name or device.moved_fixtures.count(body) > 1):
                yield path, f"`{body}` is moved by `{other}` too", "choose a fixture of its own"
    if fixtures[unit.carriage].shape == "tray":
        yield ("carriage",), f"`{unit.carriage}` is a tray", "choose a box or cylinder, and put the tray on it"
    for index, one in enumerate(unit.carries):
        if not stands_on(one, unit.carriage, fixtures, frames):
            hint = f"give it `at: {{frame: {unit.carriage}}}`, or a frame that stands on it"
            yield ("carries", index), f"`{one}` does not stand on `{unit.carriage}`", hint
    for one in fixtures:
        if one not in unit.bodies and stands_on(one, unit.carriage, fixtures, frames):
            hint = f"add it: `carries: [{', '.join((*unit.carries, one))}]`"
            yield (), f"`{one}` stands on `{unit.carriage}` and would not move with it", hint


def _place_problems(unit: LinearUnitSpec, poses: Mapping[str, Pose]) -> Iterator[_Problem]:
    lowest, highest = unit.travel_m
    if not lowest <= 0.0 <= highest or lowest == highest:
        yield ("travel_m",), "the place of the document, 0, is not within the travel", "`travel_m: [lowest, highest]`"
    if math.hypot(*unit.along) < 1e-6:
        yield ("along",), "this direction has no length", "[1, 0, 0] is along the x axis of the carriage"
    tilt_rad = math.asin(max(-1.0, min(1.0, abs(unit.direction(poses[unit.carriage])[2]))))
    if tilt_rad > _LEVEL_RAD:
        message = f"the rail is tilted by {math.degrees(tilt_rad):.1f}°: its carriage would roll while it is released"
        yield ("along",), message, "a passive linear unit is level"
    for name, place in unit.places.items():
        if found := unit.beyond_travel(place):
            yield ("places", name), f"at the place `{name}`, {found}", "move the place, or correct `travel_m`"
