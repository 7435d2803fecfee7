"""The occupancy map interface for planners: the map, its validity and its changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from engine.messages.sensing import CameraStatus, ObservedSpace, OccupancyGrid
from robots.planning.scene.planning_scene import PlanningScene

Unsubscribe = Callable[[], None]


class OccupancySource(Protocol):
    """A live occupancy map; everything happens on the event loop's thread.

    Images are taken only while the map is needed: between `require` and `release`, or while
    `cell/occupancy` has subscribers.
    """

    @property
    def latest(self) -> OccupancyGrid | None:
        """The latest map, None before the first image. Its revision increases only when voxels changed."""
        ...

    @property
    def stale_reason(self) -> str:
        """Why `latest` is not valid: no image yet, cameras lost. Empty while it is valid."""
        ...

    @property
    def observed(self) -> ObservedSpace | None:
        """When each voxel was last seen, None before the first image or if no motion asks for it."""
        ...

    @property
    def camera_statuses(self) -> tuple[CameraStatus, ...]:
        """The status of each camera. A change of one counts as a change of the map."""
        ...

    @property
    def starting(self) -> bool:
        """Whether the cameras are still starting, so that no image can have arrived."""
        ...

    def subscribe(self, callback: Callable[[], None]) -> Unsubscribe:
        """Call `callback` whenever the revision of `latest` or `stale_reason` has changed, until unsubscribed.

        This alone takes no images: see `require`.
        """
        ...

    def require(self) -> None:
        """Start taking images until as many `release` as `require` calls. The map is stale until the first image."""
        ...

    def release(self) -> None:
        """Undo one `require`."""
        ...

    def forget(self) -> None:
        """Restart with an empty map at the next image; until then `latest` stays unchanged."""
        ...

    def know(self, scene: PlanningScene) -> None:
        """Exclude the obstacles and held parts of `scene` from the next image on.

        Arms and the parts of a simulated cell use their state at the time of the image.
        """
        ...
