"""The latest occupancy map with its validity and its change subscribers."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Collection, Mapping

from engine.messages.sensing import OccupancyGrid
from robots.vision.occupancy.image_times import ImageTimes
from robots.vision.occupancy.occupancy_source import Unsubscribe

_log = logging.getLogger("flexcell.vision")


class LiveOccupancyMap:
    """Holds the latest map; owned by the event loop's thread.

    Args:
        now_s: Clock for the age of the map.
        fresh_s: Maximum age of a valid map.
        periods_s: The regular time between two images of each camera, by name.
    """

    def __init__(self, *, now_s: Callable[[], float], fresh_s: float, periods_s: Mapping[str, float]) -> None:
        self._now_s = now_s
        self._fresh_s = fresh_s
        self._looked_at_s = -math.inf
        self._times = ImageTimes(periods_s)
        self._callbacks: list[Callable[[], None]] = []
        self._published: tuple[int, str, frozenset[str]] = (0, "", frozenset())
        self.latest: OccupancyGrid | None = None
        self.required = 0
        self.starting = False
        """Whether the cameras are still starting."""
        self.unhealthy: frozenset[str] = frozenset()
        """The cameras whose images cannot be relied on; a change counts as a change of the map."""
        self.lost_reason = ""
        """Why no images arrive; empty while they can."""

    @property
    def age_s(self) -> float:
        """Age of the latest images, infinite without any."""
        return self._now_s() - self._looked_at_s

    @property
    def confirmed_age_s(self) -> float:
        """The time since which some camera has not shown what is there, as in `ImageTimes`; maybe infinite."""
        return self._now_s() - self._times.confirmed_s

    @property
    def stale_reason(self) -> str:
        """Why the map is not valid; empty while it is valid."""
        if self.lost_reason:
            return self.lost_reason
        if self.latest is None:
            return "the cameras are still starting" if self.starting else "no camera image yet"
        age_s = self.age_s
        if math.isinf(age_s):
            return "no camera image since the cell was restored to an earlier state"
        return f"the latest image is {age_s:.1f} s old" if age_s > self._fresh_s else ""

    def subscribe(self, callback: Callable[[], None]) -> Unsubscribe:
        """Call `callback` whenever the revision or the stale reason has changed."""
        self._callbacks.append(callback)

        def unsubscribe() -> None:
            if callback in self._callbacks:
                self._callbacks.remove(callback)

        return unsubscribe

    def arrived(self, grid: OccupancyGrid, *, looked_at_s: float, cameras: Collection[str]) -> bool:
        """Set a new map with images of `cameras`, taken at `looked_at_s`; return whether its voxels changed."""
        for camera in cameras:
            self._times.take(camera, looked_at_s)
        changed = self.latest is None or grid.revision != self.latest.revision
        if self.stale_reason:
            # A map becomes stale without notification; that it is valid again is still a change.
            self._published = (self._published[0], "stale", self._published[2])
        self.latest, self._looked_at_s, self.lost_reason = grid, looked_at_s, ""
        self.notify()
        return changed

    def outdated(self) -> None:
        """Invalidate the map until the next image."""
        self._looked_at_s = -math.inf
        self.begins_anew()
        self.notify()

    def begins_anew(self) -> None:
        """Take note that the next map has nothing of the earlier images."""
        self._times.forget()

    def lost(self, reason: str) -> None:
        """Set the reason why no more images arrive."""
        self.lost_reason = reason
        self.notify()

    def notify(self) -> None:
        """Notify subscribers of changes; only this checks the age of the map."""
        # A rising age is not a change.
        stale = self.lost_reason or ("stale" if self.stale_reason else "")
        now = (self.latest.revision if self.latest is not None else 0, stale, self.unhealthy)
        if now == self._published:
            return
        self._published = now
        for callback in tuple(self._callbacks):
            try:
                callback()
            except Exception:
                # A listener may fail in any way; the cameras, on which others rely, must continue.
                _log.exception("a listener to the occupancy map failed and was removed")
                self._callbacks.remove(callback)
