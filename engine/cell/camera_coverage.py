"""How much of the space that the cameras of a cell must see they do see."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from engine.messages import Vector3


class RegionCoverage(msgspec.Struct, frozen=True, kw_only=True):
    """The coverage of one region, with all arms at home: shares from 0 to 1 of the space that is not known anyway.

    `by_camera` are the shares that each camera sees by itself. `unseen_low_m` and `unseen_high_m` bound the unseen
    space; None where all is seen.
    """

    name: str
    seen: float
    by_camera: Mapping[str, float]
    unseen_low_m: Vector3 | None = None
    unseen_high_m: Vector3 | None = None


class CameraCoverage(msgspec.Struct, frozen=True, kw_only=True):
    """The coverage of each region of `must_cover`, then of the whole box of the map."""

    regions: tuple[RegionCoverage, ...]
    whole: RegionCoverage
