"""Detections of the cameras' detectors: demand, rate, topic and service; on the event loop's thread."""

from __future__ import annotations

import asyncio

import msgspec

from engine.bus import SkillBus, Topic
from engine.document import DetectionRate, ObjectDetector
from engine.errors import SkillFailed
from engine.skills.vision import Detections, DetectObjects
from robots.vision.cameras.camera import CameraSpec

_FRESH_IMAGES = 3
_LEAST_FRESH_S = 1.0
# A quarter of a period early is on time: image times are irregular.
_EARLY = 0.25


class DetectionService:
    """The detectors of a cell's cameras; ignores cameras without a detector."""

    def __init__(self, cameras: tuple[CameraSpec, ...]) -> None:
        self._detections = {
            camera.name: _CameraDetections(camera, camera.detector) for camera in cameras if camera.detector is not None
        }

    @property
    def needed(self) -> bool:
        """Whether any camera's detections are in demand."""
        return any(camera_detections.needed for camera_detections in self._detections.values())

    def due(self, cameras: tuple[CameraSpec, ...], *, now_s: float) -> tuple[str, ...]:
        """Return those of `cameras`, which take an image now, whose detectors are due."""
        found = [self._detections[camera.name] for camera in cameras if camera.name in self._detections]
        return tuple(camera_detections.name for camera_detections in found if camera_detections.begins(now_s))

    def take_result(self, found: tuple[Detections, ...]) -> None:
        """Publish detections."""
        for each in found:
            self._detections[each.camera].take_result(each)

    def fail(self, reason: str) -> None:
        """Fail all waiting requests."""
        for camera_detections in self._detections.values():
            camera_detections.fail(reason)

    def register(self, bus: SkillBus) -> None:
        """Advertise the detections of each detector as topic and service, with its parameters."""
        for camera_detections in self._detections.values():
            camera_detections.register(bus)


class _CameraDetections:
    def __init__(self, camera: CameraSpec, detector: ObjectDetector) -> None:
        self.name = camera.name
        self._camera_hz = camera.rate_hz
        self._rate_hz = detector.rate_hz
        self._is_always_on = detector.always
        self._topic: Topic[Detections] | None = None
        self._started_s = float("-inf")
        # Requests from before the image being processed, and requests since.
        self._served: list[asyncio.Future[Detections]] = []
        self._waiting: list[asyncio.Future[Detections]] = []

    @property
    def needed(self) -> bool:
        is_read = self._topic is not None and self._topic.subscriber_count > 0
        return self._is_always_on or is_read or self._is_asked

    @property
    def _is_asked(self) -> bool:
        return any(not each.done() for each in self._waiting)

    def begins(self, now_s: float) -> bool:
        """Start a detection if one is due; return whether it is."""
        period_s = 1.0 / self._rate_hz - _EARLY / self._camera_hz
        if not self.needed or (now_s < self._started_s + period_s and not self._is_asked):
            return False
        self._started_s = now_s
        self._served, self._waiting = [*self._served, *self._waiting], []
        return True

    def take_result(self, found: Detections) -> None:
        period_s = 1.0 / min(self._rate_hz, self._camera_hz)
        found = msgspec.structs.replace(found, fresh_s=max(_FRESH_IMAGES * period_s, _LEAST_FRESH_S))
        served, self._served = self._served, []
        for each in served:
            if not each.done():
                each.set_result(found)
        assert self._topic is not None
        self._topic.publish(found)

    def fail(self, reason: str) -> None:
        waiting, self._served, self._waiting = [*self._served, *self._waiting], [], []
        for each in waiting:
            if not each.done():
                each.set_exception(SkillFailed(f"nothing can be detected: {reason}", where=self.name))

    def register(self, bus: SkillBus) -> None:
        self._topic = bus.topic(f"{self.name}/detections", Detections)
        bus.advertise_service(DetectObjects, self._detect, namespace=self.name)
        rate, always = f"{self.name}/detection_rate_hz", f"{self.name}/detect_always"
        bus.parameters.declare(
            rate, DetectionRate, self._rate_hz, description="Maximum detection rate while detections have subscribers"
        )
        bus.parameters.watch(rate, self._set_rate)
        bus.parameters.declare(
            always, bool, self._is_always_on, description="Whether the detector also runs without subscribers"
        )
        bus.parameters.watch(always, self._set_always)

    async def _detect(self, request: DetectObjects) -> Detections:
        answer: asyncio.Future[Detections] = asyncio.get_running_loop().create_future()
        self._waiting.append(answer)
        return (await answer).only(labels=request.labels, minimal_score=request.minimal_score)

    def _set_rate(self, value: object) -> None:
        self._rate_hz = msgspec.convert(value, float)

    def _set_always(self, value: object) -> None:
        self._is_always_on = msgspec.convert(value, bool)
