"""The voxels of known objects follow what is there now: what is removed takes up no space any longer."""

from __future__ import annotations

from engine.messages import Pose
from engine.messages.shapes import Box, Obstacle
from robots.vision.occupancy.known_voxels import KnownVoxels
from tests.robots.vision.watched_cell import BOX

FIRST, SECOND = (
    Obstacle.of(name, Box(size_m=(0.2, 0.2, 0.2)), Pose(xyz=(x, 0.0, 0.3))) for name, x in (("one", 0.3), ("two", 0.7))
)


def test_static_objects_that_are_removed_or_moved_free_their_voxels() -> None:
    known = KnownVoxels(BOX)
    assert not known.taken((), ()).any()
    known.set_still((FIRST, SECOND))
    both = known.taken((), ()).copy()
    known.set_still((FIRST,))
    one = known.taken((), ()).copy()
    assert 0 < one.sum() < both.sum()
    known.set_still((SECOND,))
    other = known.taken((), ()).copy()
    assert other.sum() > 0
    assert not (one & other).any()
    known.set_still(())
    assert not known.taken((), ()).any()


def test_what_moves_or_is_held_counts_only_where_it_is_now() -> None:
    known = KnownVoxels(BOX)
    known.set_still((FIRST,))
    still = known.taken((), ()).copy()
    assert known.taken((SECOND,), ()).sum() > still.sum()
    assert (known.taken((), ()) == still).all()
    assert known.taken((), (SECOND,)).sum() > still.sum()
    assert (known.taken((), ()) == still).all()
