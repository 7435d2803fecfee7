"""What a planner needs of whoever keeps the occupancy map: the map itself, whether to trust it, when it changed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from engine.messages.sensing import OccupancyGrid
from robots.planning.scene.planning_scene import PlanningScene

Unsubscribe = Callable[[], None]


class OccupancySource(Protocol):
    """A live occupancy map; everything happens on the event loop's thread.

    Images are taken only while somebody needs the map: between `require` and `release`, or while
    `cell/occupancy` has subscribers.
    """

    @property
    def latest(self) -> OccupancyGrid | None:
        """The newest map, None before the first image. Its revision rises only when voxels changed."""
        ...

    @property
    def stale_reason(self) -> str:
        """Why `latest` must not be trusted, in words: no image yet, cameras lost. Empty while it may be."""
        ...

    @property
    def starting(self) -> bool:
        """Whether what takes the images is still being started, so that none can have come."""
        ...

    def subscribe(self, callback: Callable[[], None]) -> Unsubscribe:
        """Call `callback` whenever the revision of `latest` or `stale_reason` has changed, until unsubscribed.

        This alone takes no images: see `require`.
        """
        ...

    def require(self) -> None:
        """Take images from now on, until as many `release` as `require`. The map is stale until the first one."""
        ...

    def release(self) -> None:
        """Say that one who required the map needs it no more."""
        ...

    def forget(self) -> None:
        """Begin with an empty map at the next image; until then `latest` stays as it is."""
        ...

    def know(self, scene: PlanningScene) -> None:
        """Leave out the obstacles and held parts of `scene` from the next image on.

        Arms and the parts of a simulated cell are taken where they were when the image was made.
        """
        ...
