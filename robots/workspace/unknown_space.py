"""What a cell demands of space that its cameras have not seen, and the words for it."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
import numpy as np

from engine.document import OccupancyMap, UnknownSpacePolicy
from engine.messages import Vector3
from engine.messages.sensing import CameraStatus, ObservedSpace, OccupancyGrid
from robots.planning.swept_space import CoverRegion, SweptSpace
from robots.planning.unknown_voxels import unknown_voxels

SLOW_SPEED = 0.1
"""Share of the joint speed limits at which an arm passes through unknown space, by the policy `slow`."""


class UnknownSpaceRule(msgspec.Struct, frozen=True, kw_only=True):
    """The policy of a cell, the regions to which it applies (everywhere without any), and what is known near an arm."""

    policy: UnknownSpacePolicy = "accept"
    regions: tuple[CoverRegion, ...] = ()
    near_m: float = 0.04

    @classmethod
    def of(cls, occupancy: OccupancyMap | None, *, cameras: Iterable[str]) -> UnknownSpaceRule:
        """Return the rule of a cell document; without cameras all space is accepted."""
        if occupancy is None or not tuple(cameras):
            return cls()
        return cls(
            policy=occupancy.unknown_space_policy,
            regions=tuple(
                CoverRegion(name=name, center_m=region.center_m, size_m=region.size_m)
                for name, region in occupancy.must_cover.items()
            ),
            near_m=occupancy.robot_margin_m,
        )

    def as_occupied(self, grid: OccupancyGrid, observed: ObservedSpace) -> OccupancyGrid:
        """Return a map in which the unknown space counts as occupied."""
        unknown = np.packbits(unknown_voxels(observed, self.regions).reshape(-1))
        occupied = np.frombuffer(grid.occupied, dtype=np.uint8) | unknown
        return msgspec.structs.replace(grid, occupied=occupied.tobytes())


def describe_unknown(swept: SweptSpace, *, arm: str, duration_s: float, statuses: Iterable[CameraStatus]) -> str:
    """Return what space is unknown, where it is, and what the cameras have to do with it."""
    size = tuple(high - low for low, high in zip(swept.low_m, swept.high_m, strict=True))
    share = swept.at_s / duration_s if duration_s > 0.0 else 0.0
    age = "has never been seen" if swept.age_s is None else f"was last seen {swept.age_s:.1f} s ago"
    region = f" in {', '.join(swept.regions)}" if swept.regions else ""
    return (
        f"{arm} would pass through {1000.0 * swept.unknown_m3:.1f} l of unknown space{region}, first at "
        f"{_point(swept.first_m)} m after {share:.0%} of the path, which {age}; it extends over {_size(size)} m "
        f"({describe_cameras(statuses)})"
    )


def describe_cameras(statuses: Iterable[CameraStatus]) -> str:
    """Return the conditions of cameras: `camera top is covered: …; camera side is healthy and does not see it`."""
    words = [
        f"camera {status.camera} is {status.condition}: {status.cause}"
        if status.unhealthy
        else f"camera {status.camera} does not see it"
        for status in statuses
    ]
    return "; ".join(words) or "no camera sees it"


def describe_unhealthy(statuses: Iterable[CameraStatus]) -> str:
    """Return why images cannot be relied on, empty if all can."""
    return "; ".join(f"camera {one.camera} is {one.condition}: {one.cause}" for one in statuses if one.unhealthy)


def _point(values: Vector3) -> str:
    return f"({', '.join(f'{value:.2f}' for value in values)})"


def _size(values: tuple[float, ...]) -> str:
    return " x ".join(f"{value:.2f}" for value in values)
