"""What a document may say of hexapods: names that lead somewhere, and poses that the legs reach."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain

from engine.document.cell_bodies import Fixture
from engine.document.cell_devices import DeviceSpec
from engine.document.cell_frames import FrameSpec, poses_in_world, stands_on
from engine.document.hexapods.hexapod_geometry import beyond_limits
from engine.document.hexapods.hexapod_spec import HexapodSpec
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.wording import did_you_mean

_Problem = tuple[DataPath, str, str]


def require_hexapods(
    devices: Mapping[str, DeviceSpec],
    source: DocumentSource,
    *,
    fixtures: Mapping[str, Fixture],
    frames: Mapping[str, FrameSpec],
    uses: Iterable[tuple[DataPath, str]],
) -> None:
    """Require hexapods that can be built, and whose poses are within the limits of their legs.

    Frames and fixtures lead to the world, as `require_frames` requires; `uses` says in which frames the rest stands.

    Raises:
        DocumentError: `where` is the position in the document.
    """
    hexapods = {name: device.hexapod for name, device in devices.items() if device.hexapod is not None}
    if not hexapods:
        return
    poses, used_frames = poses_in_world(frames, fixtures), tuple(uses)
    moved = {axis.body: f"an axis of `{name}`" for name, device in devices.items() for axis in device.axes.values()}
    platforms: dict[str, str] = {}
    for name, hexapod in hexapods.items():
        path: DataPath = ("devices", name, "hexapod")
        # One after the other: each set of rules counts on those before it.
        for inner, message, hint in chain(
            _name_problems(hexapod, devices[name], fixtures, frames),
            _body_problems(name, hexapod, fixtures, {**moved, **platforms}),
            _pose_problems(hexapod, poses),
            _carry_problems(hexapod, fixtures, frames),
        ):
            raise DocumentError(message, where=source.position((*path, *inner)), hint=hint)
        platforms |= dict.fromkeys(hexapod.bodies, f"the hexapod `{name}`")
        for used, frame in used_frames:
            if used[0] not in ("parts", "unknown_bodies") and stands_on(frame, hexapod.platform, fixtures, frames):
                raise DocumentError(
                    f"`{used[1]}` stands on the platform of `{name}`, which moves",
                    where=source.position(used),
                    hint="only fixtures, frames and parts stand on a platform: place it elsewhere",
                )


def _name_problems(
    hexapod: HexapodSpec, device: DeviceSpec, fixtures: Mapping[str, Fixture], frames: Mapping[str, FrameSpec]
) -> Iterator[_Problem]:
    named: list[tuple[DataPath, str]] = [(("base",), hexapod.base), (("platform",), hexapod.platform)]
    named += [(("carries", index), one) for index, one in enumerate(hexapod.carries)]
    for path, fixture in named:
        if fixture not in fixtures:
            yield path, f"there is no fixture `{fixture}`", did_you_mean(fixture, fixtures)
    if hexapod.base == hexapod.platform:
        yield ("platform",), "base and platform are the same fixture", "name the plate that moves"
    if hexapod.grip not in frames:
        yield ("grip",), f"there is no frame `{hexapod.grip}`", did_you_mean(hexapod.grip, frames)
    elif not stands_on(hexapod.grip, hexapod.platform, fixtures, frames):
        yield ("grip",), f"`{hexapod.grip}` does not stand on the platform", f"give it `parent: {hexapod.platform}`"
    if hexapod.brakes not in device.outputs:
        yield ("brakes",), f"no step sets the output `{hexapod.brakes}`", did_you_mean(hexapod.brakes, device.outputs)
    for field, position in (("released", hexapod.released), ("locked", hexapod.locked)):
        if position not in device.positions:
            hint = did_you_mean(position, device.positions)
            yield (field,), f"the device has no position `{position}` for its brakes", hint


def _body_problems(
    name: str, hexapod: HexapodSpec, fixtures: Mapping[str, Fixture], moved: Mapping[str, str]
) -> Iterator[_Problem]:
    for field, body in (("base", hexapod.base), ("platform", hexapod.platform)):
        if body in moved:
            yield (field,), f"`{body}` is moved by {moved[body]} too", "choose a fixture of its own"
    if (shape := fixtures[hexapod.platform].shape) in {"tray", "mesh"}:
        yield (
            ("platform",),
            f"`{hexapod.platform}` is a {shape}",
            f"choose a box or cylinder with the {shape} on it",
        )
    for path, body in ((("platform",), hexapod.platform), *((("carries",), one) for one in hexapod.carries)):
        if fixtures[body].spring is not None:
            yield path, f"`{body}` has a spring and cannot be moved", "remove the spring"
    if hexapod.length_m[0] >= hexapod.length_m[1]:
        yield ("length_m",), "the shortest leg is not shorter than the longest", "`length_m: [shortest, longest]`"
    if len(set(hexapod.carries)) != len(hexapod.carries) or hexapod.platform in hexapod.carries:
        yield ("carries",), f"a fixture stands on the platform of `{name}` twice", "name each once"


def _pose_problems(hexapod: HexapodSpec, poses: Mapping[str, Pose]) -> Iterator[_Problem]:
    start = compose_poses(invert_pose(poses[hexapod.base]), poses[hexapod.platform])
    hint = "move the pose, or correct the joints and `length_m`"
    if found := beyond_limits(hexapod, start):
        yield ("platform",), f"where `{hexapod.platform}` stands, {found}", hint
    for name, placement in hexapod.poses.items():
        if found := beyond_limits(hexapod, placement.pose()):
            yield ("poses", name), f"at the pose `{name}`, {found}", hint


def _carry_problems(
    hexapod: HexapodSpec, fixtures: Mapping[str, Fixture], frames: Mapping[str, FrameSpec]
) -> Iterator[_Problem]:
    for index, one in enumerate(hexapod.carries):
        if not stands_on(one, hexapod.platform, fixtures, frames):
            hint = f"give it `at: {{frame: {hexapod.platform}}}`, or a frame that stands on it"
            yield ("carries", index), f"`{one}` does not stand on `{hexapod.platform}`", hint
    for one in fixtures:
        if one not in hexapod.bodies and stands_on(one, hexapod.platform, fixtures, frames):
            hint = f"add it: `carries: [{', '.join((*hexapod.carries, one))}]`"
            yield (), f"`{one}` stands on `{hexapod.platform}` and would not move with it", hint
