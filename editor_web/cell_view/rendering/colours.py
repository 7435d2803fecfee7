"""Colours from numbers."""

from __future__ import annotations

import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Stops = Sequence[tuple[int, int, int]]
# Distinguishable with colour blindness, on light and dark backgrounds (after Okabe and Ito, and Tol).
_NAMED = (
    (0, 158, 115),
    (230, 159, 0),
    (204, 121, 167),
    (86, 180, 233),
    (213, 94, 0),
    (0, 114, 178),
    (136, 34, 85),
    (153, 153, 51),
)


def ramp(stops: Stops, share: NDArray[np.floating]) -> NDArray[np.uint8]:
    """Return the colours (… x 3) at fractions 0 to 1 along evenly spaced stops; other values are clipped."""
    at = np.linspace(0.0, 1.0, len(stops))
    channels = [np.interp(share, at, [stop[channel] for stop in stops]) for channel in range(3)]
    return np.stack(channels, axis=-1).round().astype(np.uint8)


def colour_of_name(name: str) -> tuple[int, int, int]:
    """Return the colour of a name, always the same one; other names may share it."""
    return _NAMED[zlib.crc32(name.encode()) % len(_NAMED)]
