"""Named frames of a cell: each is fixed to the world, to a fixture or to another frame."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Annotated

from msgspec import Meta

from engine.document.placement import Placement
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses
from engine.wording import did_you_mean

WORLD = "world"
_RESERVED = {WORLD: "root frame", "occupancy": "map of occupied space"}


class FrameSpec(StrictModel, frozen=True, kw_only=True):
    """A frame that stands at a pose in its parent."""

    parent: Annotated[
        str, Meta(min_length=1, description="What it is fixed to: `world`, a fixture, or another frame")
    ] = WORLD
    at: Placement = Placement()


def fixed_frames(frames: Mapping[str, FrameSpec], fixtures: Mapping[str, Pose]) -> dict[str, Pose]:
    """Return the poses of all frames in the world; `fixtures` are those of what they may stand on.

    The parents are known and form no circle, as `require_frames` requires.
    """
    known: dict[str, Pose] = {WORLD: Pose(xyz=(0.0, 0.0, 0.0)), **fixtures}

    def pose(name: str) -> Pose:
        if name not in known:
            spec = frames[name]
            known[name] = compose_poses(pose(spec.parent), spec.at.pose())
        return known[name]

    return {name: pose(name) for name in frames}


def require_frames(
    frames: Mapping[str, FrameSpec], source: DocumentSource, *, fixtures: Collection[str], taken: Mapping[str, str]
) -> None:
    """Require names of their own, and parents that lead to the world.

    Args:
        frames: The frames of the cell.
        source: The document.
        fixtures: The names of the fixtures.
        taken: What else has a name in the world, with what it is.

    Raises:
        DocumentError: a name is taken, a parent is unknown, or frames are the parents of one another.
    """
    others = {**taken, **_RESERVED}
    for name, spec in frames.items():
        path: DataPath = ("frames", name)
        if name in others:
            raise DocumentError(
                f"`{name}` is both a frame and a {others[name]}",
                where=source.position(path, of_key=True),
                hint="rename one",
            )
        known = {WORLD, *fixtures, *frames} - {name}
        if spec.parent not in known:
            what = "itself" if spec.parent == name else "no fixture and no frame of the cell"
            raise DocumentError(
                f"the parent of frame `{name}`, `{spec.parent}`, is {what}",
                where=source.position((*path, "parent")),
                hint=did_you_mean(spec.parent, known),
            )
    for name in frames:
        chain = [name]
        while (parent := frames[chain[-1]].parent) in frames:
            chain.append(parent)
            if parent == name:
                raise DocumentError(
                    f"the frames {' → '.join(chain)} are parents of one another",
                    where=source.position(("frames", name, "parent")),
                    hint="fix one of them to `world` or to a fixture",
                )
            if parent in chain[:-1]:
                break
