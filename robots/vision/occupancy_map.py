"""The newest map with all that is to be said of it: who needs it, whether it may be trusted, who hears of changes."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable

from engine.messages.sensing import OccupancyGrid
from robots.vision.occupancy_source import Unsubscribe

_log = logging.getLogger("flexcell.vision")


class LiveOccupancyMap:
    """Keeps the newest map, for whoever takes the images; belongs to the event loop's thread.

    Args:
        now_s: The time by which a map's age is told.
        fresh_s: A map older than this must not be trusted.
    """

    def __init__(self, *, now_s: Callable[[], float], fresh_s: float) -> None:
        self._now_s = now_s
        self._fresh_s = fresh_s
        self._looked_at_s = -math.inf
        self._callbacks: list[Callable[[], None]] = []
        self._told: tuple[int, str] = (0, "")
        self.latest: OccupancyGrid | None = None
        self.required = 0
        self.starting = False
        """Whether the cameras are still being started."""
        self.lost_reason = ""
        """Why no images come, in words; empty while they could."""

    @property
    def stale_reason(self) -> str:
        """Why the map must not be trusted, empty while it may be."""
        if self.lost_reason:
            return self.lost_reason
        if self.latest is None:
            return "the cameras are still starting" if self.starting else "no camera image yet"
        age_s = self._now_s() - self._looked_at_s
        if math.isinf(age_s):
            return "no camera image since the cell was restored to an earlier state"
        return f"the newest image is {age_s:.1f} s old" if age_s > self._fresh_s else ""

    def subscribe(self, callback: Callable[[], None]) -> Unsubscribe:
        """Call `callback` whenever the revision or the stale reason has changed."""
        self._callbacks.append(callback)

        def unsubscribe() -> None:
            if callback in self._callbacks:
                self._callbacks.remove(callback)

        return unsubscribe

    def arrived(self, grid: OccupancyGrid, *, looked_at_s: float) -> bool:
        """Take a new map, of images taken at `looked_at_s`; return whether its voxels changed."""
        changed = self.latest is None or grid.revision != self.latest.revision
        if self.stale_reason:
            # Nobody tells when a map grows too old; that it is fresh again is news all the same.
            self._told = (self._told[0], "stale")
        self.latest, self._looked_at_s, self.lost_reason = grid, looked_at_s, ""
        self.tell()
        return changed

    def outdated(self) -> None:
        """Say that the map is of another time; nobody may trust it before the next image."""
        self._looked_at_s = -math.inf
        self.tell()

    def lost(self, reason: str) -> None:
        """Say why no images come any more."""
        self.lost_reason = reason
        self.tell()

    def tell(self) -> None:
        """Call back if there is anything new: the age of a map is looked at only here."""
        # Ages that rise are no news.
        stale = self.lost_reason or ("stale" if self.stale_reason else "")
        now = (self.latest.revision if self.latest is not None else 0, stale)
        if now == self._told:
            return
        self._told = now
        for callback in tuple(self._callbacks):
            try:
                callback()
            except Exception:
                # Any listener may fail in any way; the cameras, on which others rely, must go on.
                _log.exception("a listener to the occupancy map failed and was removed")
                self._callbacks.remove(callback)
