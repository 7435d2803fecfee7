"""Which bodies of a cell touch, or nearly do, before anything has moved."""

from __future__ import annotations

import msgspec


class RestContact(msgspec.Struct, frozen=True, kw_only=True):
    """Two bodies of a cell with all arms at home, by their names: `left/panda_hand`, `table`, `vice/main_jaw`.

    `distance_m` is the distance of their shapes, 0 or less where they overlap by as much.
    """

    first: str
    second: str
    distance_m: float
