"""What is joined to a displaced part is displaced with it."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from engine.document import joined_groups
from engine.document.cell import Cell, CellDocument
from engine.document.placement import FramedPlacement
from engine.errors import DocumentError
from engine.messages.pose_algebra import compose_poses, invert_pose


def carried_parts(cell: Cell, varied: CellDocument, moved: Collection[str]) -> Iterator[tuple[str, FramedPlacement]]:
    """Yield the parts that are joined to displaced ones, with their places in the world.

    Args:
        cell: The cell as written.
        varied: Its document with the displaced parts, and all others as written.
        moved: The displaced parts.

    Raises:
        DocumentError: a displaced part is joined to a fixture, or to another displaced part.
    """
    parts = cell.document.parts
    for group in joined_groups(cell.document.bonds):
        leaders = sorted(group.intersection(moved))
        if not leaders:
            continue
        leader, where = leaders[0], f"displace.{leaders[0]}"
        fixed = sorted(name for name in group if name not in parts)
        if fixed:
            raise DocumentError(
                f"`{leader}` is joined to the fixture `{fixed[0]}`", where=where, hint="displace a part that is free"
            )
        if len(leaders) > 1:
            raise DocumentError(
                f"`{leader}` and `{leaders[1]}` are joined and are displaced as one",
                where=where,
                hint=f"displace `{leader}` only",
            )
        shift = compose_poses(varied.parts[leader].at.pose(), invert_pose(parts[leader].at.pose()))
        for name in sorted(group - {leader}):
            yield name, FramedPlacement.of(compose_poses(shift, parts[name].at.pose()))
