"""Up to when each camera has shown what is in the occupancy map."""

from __future__ import annotations

import math
from collections.abc import Mapping

# A longer gap between two images, in periods of the camera, is a pause.
_REGULAR = 1.5


class ImageTimes:
    """The times of the images in a map.

    A voxel beside one that is full already becomes full with the second image. So an image after a pause confirms
    nothing yet, but for the first period and a half of that pause.

    Args:
        periods_s: The regular time between two images of each camera, by name.
    """

    def __init__(self, periods_s: Mapping[str, float]) -> None:
        self._periods_s = dict(periods_s)
        self._latest_s: dict[str, float] = {}
        self._confirmed_s: dict[str, float] = {}

    @property
    def confirmed_s(self) -> float:
        """Up to when all cameras have shown what is there; minus infinity before the second image of each."""
        return min((self._confirmed_s.get(camera, -math.inf) for camera in self._periods_s), default=-math.inf)

    def take(self, camera: str, at_s: float) -> None:
        """Take note of an image."""
        before_s = self._latest_s.get(camera, -math.inf)
        self._latest_s[camera] = at_s
        self._confirmed_s[camera] = min(at_s, before_s + _REGULAR * self._periods_s[camera])

    def forget(self) -> None:
        """Take note that the map begins anew, without these images."""
        self._latest_s.clear()
        self._confirmed_s.clear()
