"""Named frames of a cell: each is fixed to the world, to a fixture or to another frame."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated

from msgspec import Meta

from engine.document.cell_bodies import Fixture
from engine.document.placement import Placement
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses
from engine.wording import did_you_mean

WORLD = "world"
_ROOT = Pose(xyz=(0.0, 0.0, 0.0))
_RESERVED = {WORLD: "root frame", "occupancy": "map of occupied space"}


class FrameSpec(StrictModel, frozen=True, kw_only=True):
    """A frame that stands at a pose in its parent."""

    parent: Annotated[
        str, Meta(min_length=1, description="What it is fixed to: `world`, a fixture, or another frame")
    ] = WORLD
    at: Placement = Placement()


def poses_in_world(frames: Mapping[str, FrameSpec], fixtures: Mapping[str, Fixture]) -> dict[str, Pose]:
    """Return the poses of all frames, those of fixtures and `world` among them, in the world.

    The parents are known and form no circle, as `require_frames` requires.
    """
    anchors = _anchors(frames, fixtures)
    known = {WORLD: _ROOT}
    for name in anchors:
        chain = [name]
        while chain[-1] not in known:
            chain.append(anchors[chain[-1]][0])
        for each in reversed(chain[:-1]):
            parent, pose = anchors[each]
            known[each] = compose_poses(known[parent], pose)
    return known


def stands_on(frame: str, on: str, fixtures: Mapping[str, Fixture], frames: Mapping[str, FrameSpec]) -> bool:
    """Return whether a frame or fixture is, or stands on, another one; frames lead to the world."""
    while frame not in (WORLD, on):
        frame = frames[frame].parent if frame in frames else fixtures[frame].at.frame
    return frame == on


def require_frames(
    frames: Mapping[str, FrameSpec],
    source: DocumentSource,
    *,
    fixtures: Mapping[str, Fixture],
    uses: Iterator[tuple[DataPath, str]],
    taken: Mapping[str, str],
    whole: str = "cell",
) -> None:
    """Require names of their own, and that everything stands in a frame that leads to the world.

    Args:
        frames: The frames of the cell.
        source: The document.
        fixtures: The fixtures, which are frames too.
        uses: The frames in which things stand that are none, each with its path in the document.
        taken: What else has a name in the world, with what it is.
        whole: What the document describes.

    Raises:
        DocumentError: a name is taken, a frame is unknown, or frames stand in one another.
    """
    others = {**taken, **_RESERVED}
    for name in frames:
        if name in others:
            raise DocumentError(
                f"`{name}` is both a frame and a {others[name]}",
                where=source.position(("frames", name), of_key=True),
                hint="rename one",
            )
    known = {WORLD, *fixtures, *frames}
    paths: dict[str, DataPath] = {name: ("frames", name, "parent") for name in frames}
    paths |= {name: ("fixtures", name, "at", "frame") for name in fixtures}
    parents = {name: parent for name, (parent, _) in _anchors(frames, fixtures).items()}
    required = [(paths[name], parent, known - {name}) for name, parent in parents.items()]
    required += [(path, frame, known) for path, frame in uses]
    for path, frame, possible in required:
        if frame not in possible:
            odd = "itself" if frame == path[1] else f"`{frame}`, which is no frame and no fixture of the {whole}"
            hint = did_you_mean(frame, possible)
            raise DocumentError(f"`{path[1]}` stands in {odd}", where=source.position(path), hint=hint)
    _require_no_circle(parents, paths, source)


def _require_no_circle(parents: Mapping[str, str], paths: Mapping[str, DataPath], source: DocumentSource) -> None:
    grounded = {WORLD}
    for name in parents:
        chain = [name]
        while chain[-1] not in grounded:
            parent = parents[chain[-1]]
            if parent in chain:
                circle = [*chain[chain.index(parent) :], parent]
                raise DocumentError(
                    f"{' → '.join(circle)} stand in one another",
                    where=source.position(paths[parent]),
                    hint="place one of them in `world`",
                )
            chain.append(parent)
        grounded.update(chain)


def _anchors(frames: Mapping[str, FrameSpec], fixtures: Mapping[str, Fixture]) -> dict[str, tuple[str, Pose]]:
    """Return in which frame each frame and fixture stands, and at which pose."""
    return {
        **{name: (spec.parent, spec.at.pose()) for name, spec in frames.items()},
        **{name: (fixture.at.frame, fixture.at.pose()) for name, fixture in fixtures.items()},
    }
