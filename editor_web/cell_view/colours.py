"""Colours from numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Stops = Sequence[tuple[int, int, int]]


def ramp(stops: Stops, share: NDArray[np.floating]) -> NDArray[np.uint8]:
    """Return the colours (… x 3) at shares 0 to 1 of the way along evenly spaced stops; others are clipped."""
    at = np.linspace(0.0, 1.0, len(stops))
    channels = [np.interp(share, at, [stop[channel] for stop in stops]) for channel in range(3)]
    return np.stack(channels, axis=-1).round().astype(np.uint8)
