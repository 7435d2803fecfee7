"""The cameras in virtual time: images are taken between two steps of the world; the map follows some steps later."""

from __future__ import annotations

import math
from types import TracebackType
from typing import Protocol, Self

import msgspec

from engine.errors import CellError
from engine.robot import DeviceStatus
from robots.sim.world.sim_world import SimWorld
from robots.vision.known_geometry import KnownGeometry
from robots.vision.perception_device import PROCESSING_S, PerceptionDevice
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup


class _CameraRig(Protocol):
    @property
    def words(self) -> str: ...

    def know(self, known: KnownGeometry) -> None: ...

    def change(self, setup: PerceptionSetup) -> None: ...

    def look(self, look: PerceptionRequest) -> PerceptionResult: ...

    def close(self) -> None: ...


class LockstepPerception(PerceptionDevice):
    """Renders on the event loop's thread; the copy of the cell is built on first use: most runs need none.

    The computing times in `OccupancyState` are 0 here, as they would differ between runs.
    """

    def __init__(self, setup: PerceptionSetup, *, world: SimWorld) -> None:
        step_s = setup.scene.step_s
        self._steps = 0
        super().__init__(setup, world=world, now_s=lambda: self._steps * step_s)
        self._every = {camera.name: max(1, round(1.0 / (camera.rate_hz * step_s))) for camera in setup.cameras}
        # Common divisor of all periods: nothing can be due in between.
        self._tick = math.gcd(*self._every.values())
        self._later = max(1, round(PROCESSING_S / step_s))
        self._coming: tuple[int, PerceptionResult] | None = None
        self._eye: _CameraRig | None = None
        self._sent_known, self._sent_setup = self.known, setup
        world.each_step(self._after_step, busy=lambda: self.needed or self._coming is not None)

    async def __aenter__(self) -> Self:
        self.status = DeviceStatus.READY
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.status = DeviceStatus.DISCONNECTED
        self.detections.fail("the cell is closed")
        eye, self._eye = self._eye, None
        if eye is not None:
            eye.close()

    def _after_step(self) -> bool:
        """Deliver finished results, render if due; return whether callbacks ran."""
        self._steps += 1
        notified = False
        if self._coming is not None and self._steps >= self._coming[0] + self._later:
            (taken, seen), self._coming = self._coming, None
            self.take_result(seen, looked_at_s=taken * self.setup.scene.step_s)
            notified = True
        if self._steps % self._tick == 0 and self.needed:
            notified = self._look_if_due() or notified
        return notified

    def _look_if_due(self) -> bool:
        """Render if due; return whether a failure was reported."""
        due = tuple(camera for camera in self.setup.cameras if self._steps % self._every[camera.name] == 0)
        if due and self._coming is not None:
            self.dropped += 1
        elif due:
            order = self.next_look(due, now_s=self._steps * self.setup.scene.step_s)
            try:
                self._coming = (self._steps, self._look(order)) if order is not None else None
            except CellError as error:
                # Waiting detections fail; users of the map are notified that it is stale.
                self.fail(str(error))
                return True
        return False

    def _look(self, order: PerceptionRequest) -> PerceptionResult:
        if self._eye is None:
            # Imported here: it loads the compiled kernels and coal.
            from robots.vision.camera_rig import CameraRig

            self._eye, self._sent_setup = CameraRig(self.setup, repeatable=True), self.setup
            self.set_rendering(self._eye.words)
        if self.setup is not self._sent_setup:
            self._eye.change(self.setup)
            self._sent_setup = self.setup
        if self.known is not None and self.known is not self._sent_known:
            self._eye.know(self.known)
            self._sent_known = self.known
        return msgspec.structs.replace(self._eye.look(order), render_s=0.0, map_s=0.0)
