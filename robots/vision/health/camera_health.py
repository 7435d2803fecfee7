"""The condition of one camera, judged by each of its images."""

from __future__ import annotations

import math

import numpy as np

from engine.messages.sensing import CameraCondition, CameraStatus, DepthImage
from robots.port import Array
from robots.vision.cameras.camera import CameraSpec, Image, depths
from robots.vision.health.expected_view import ExpectedView, Flags, ViewComparison

_DARK = 0.03
"""Mean brightness below which a camera counts as dark."""
_COVERED_SHARE = 0.9
_UNIFORM_SHARE, _NEAR_M = 0.1, 0.5
_STATISTICS_PIXELS = 5000
_LATE_PERIODS, _LEAST_LATE_S = 3.0, 0.3
_EQUAL_IMAGES = 2
"""Repeated images that count as frozen where they should differ."""
_MOVED_PIXELS = 4
_LEAST_PIXELS, _FARTHER_SHARE = 20, 0.1
_NEARER_SHARE, _NEARER_SPREAD_M = 0.7, 0.03
_LEAST_ARM_PIXELS, _THROUGH_SHARE = 6, 0.5
_AGREES_SHARE = 0.5
_GOOD_IMAGES, _BAD_IMAGES = 3, 2
"""Consecutive images after which a condition ends, and after which a suspicion counts."""
_GAP_S = 1.0
_CERTAIN: frozenset[CameraCondition] = frozenset(("covered", "dark", "late"))

_Verdict = tuple[CameraCondition, str]
_HEALTHY: _Verdict = ("healthy", "")


class CameraHealth:
    """Keeps the condition of a camera with its cause.

    A condition that one image shows for certain holds at once, a suspicion with the second image, and both end after
    three good ones; after a second without images the first one decides alone.

    Args:
        camera: The camera as it is calibrated.
        view: What it must see; None if nothing is known.
    """

    def __init__(self, camera: CameraSpec, view: ExpectedView | None) -> None:
        self._camera = camera
        self._view = view
        self._last = b""
        self._equal = 0
        self._arms_then: Flags | None = None
        self._has_agreed = False
        self._judged_s = -math.inf
        self._streak = 0
        self._suspected: CameraCondition = "unknown"
        self.status = CameraStatus(time_s=0.0, camera=camera.name, condition="unknown")

    def judge(self, image: DepthImage | None, balls: Array, *, now_s: float) -> CameraStatus:
        """Return the status after an image of now, None if none came; `balls` are the spheres of all arms (m, 4)."""
        self._settle(self._verdict(image, balls, now_s), now_s)
        return self.status

    def _settle(self, verdict: _Verdict, now_s: float) -> None:
        condition, cause = verdict
        decides = now_s - self._judged_s > _GAP_S or self.status.condition == "unknown"
        self._judged_s = now_s
        self._streak = self._streak + 1 if condition == self._suspected else 1
        self._suspected = condition
        needed = _GOOD_IMAGES if condition == "healthy" else 1 if condition in _CERTAIN else _BAD_IMAGES
        if condition == self.status.condition:
            # The figures of a cause change with each image; the first ones stay.
            return
        if decides or self._streak >= needed or (condition != "healthy" and self.status.unhealthy):
            self.status = CameraStatus(time_s=now_s, camera=self._camera.name, condition=condition, cause=cause)

    def _verdict(self, image: DepthImage | None, balls: Array, now_s: float) -> _Verdict:
        limit_s = max(_LATE_PERIODS / self._camera.rate_hz, _LEAST_LATE_S)
        if image is None:
            return "late", "it delivers no images"
        if now_s - image.time_s > limit_s:
            return "late", f"its latest image is {now_s - image.time_s:.2f} s old, more than {limit_s:.2f} s"
        depth = depths(image)
        comparison = self._view.compare(depth, balls) if self._view is not None else None
        if found := self._blind(image, depth, comparison) or self._frozen(image, comparison):
            return found
        return (self._moved(comparison) if comparison is not None else None) or _HEALTHY

    def _blind(self, image: DepthImage, depth: Image, comparison: ViewComparison | None) -> _Verdict | None:
        nothing = float((depth == 0.0).mean())
        if image.brightness is not None and image.brightness < _DARK:
            return "dark", f"the mean brightness of its image is {image.brightness:.2f}, below {_DARK}"
        if nothing > _COVERED_SHARE:
            return "covered", f"{nothing:.0%} of its pixels measure nothing"
        # Some thousand pixels tell as much as all.
        step = max(1, math.isqrt(depth.size // _STATISTICS_PIXELS))
        depth = depth[::step, ::step]
        hits = depth[np.isfinite(depth) & (depth > 0.0)]
        if len(hits) < _COVERED_SHARE * depth.size:
            return None
        low, middle, high = np.percentile(hits, (5, 50, 95)).tolist()
        is_uniform = high - low < _UNIFORM_SHARE * middle
        expects = comparison is not None and comparison.fixtures >= _LEAST_PIXELS
        hides = comparison is not None and comparison.nearer > _COVERED_SHARE * comparison.fixtures
        if is_uniform and (hides if expects else middle < _NEAR_M):
            return "covered", f"a surface at {middle:.2f} m hides everything behind it"
        return None

    def _frozen(self, image: DepthImage, comparison: ViewComparison | None) -> _Verdict | None:
        arms = comparison.silhouette if comparison is not None else None
        if image.depth_m != self._last:
            self._last, self._equal, self._arms_then = image.depth_m, 0, arms
            return None
        self._equal += 1
        moved = int((arms ^ self._arms_then).sum()) if arms is not None and self._arms_then is not None else 0
        if self._equal >= _EQUAL_IMAGES and self._camera.noise_m > 0.0:
            return "frozen", f"{self._equal + 1} successive images are equal, although each has its own noise"
        if self._equal >= _EQUAL_IMAGES and moved >= _MOVED_PIXELS:
            return "frozen", f"{self._equal + 1} successive images are equal, although an arm has moved in its view"
        return None

    def _moved(self, comparison: ViewComparison) -> _Verdict | None:
        cause = _disagreement(comparison)
        if not cause:
            agreed = comparison.fixtures - comparison.nearer - comparison.farther
            self._has_agreed = self._has_agreed or agreed > max(_LEAST_PIXELS, _AGREES_SHARE * comparison.fixtures)
            return None
        if self._has_agreed:
            return "displaced", f"{cause}; before they agreed"
        return "miscalibrated", f"{cause}; they have never agreed"


def _disagreement(comparison: ViewComparison) -> str:
    """Return what in an image contradicts the known geometry, empty if nothing does.

    What is nearer than expected may be an unknown body; what is farther cannot be.
    """
    fixtures, arms = comparison.fixtures, comparison.arms
    if fixtures >= _LEAST_PIXELS and comparison.farther > _FARTHER_SHARE * fixtures:
        return f"it looks through fixtures at {comparison.farther / fixtures:.0%} of the pixels that must show one"
    if arms >= _LEAST_ARM_PIXELS and comparison.through_arms > _THROUGH_SHARE * arms:
        return f"it looks through an arm at {comparison.through_arms / arms:.0%} of the pixels that must show one"
    is_shifted = comparison.nearer_spread_m < _NEARER_SPREAD_M
    if fixtures >= _LEAST_PIXELS and comparison.nearer > _NEARER_SHARE * fixtures and is_shifted:
        return f"it measures fixtures nearer by {comparison.nearer_m:.2f} m than they are"
    return ""
