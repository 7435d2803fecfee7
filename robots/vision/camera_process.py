"""The client of the camera process on the event loop: starts it, sends requests, and never reuses a lost process."""

from __future__ import annotations

import asyncio

from engine.errors import RobotError
from robots.io.worker_process import WorkerProcess
from robots.vision.camera_process_messages import FromCameras, PerceptionReady, ToCameras
from robots.vision.known_geometry import KnownGeometry
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup

_START = "from robots.vision.camera_process_main import main; main()"
_WHAT = "the camera process"
# Rendering on the CPU would use all cores, including that of the control loop.
_SETTINGS = {"LP_NUM_THREADS": "1"}
# The first start on a machine compiles the kernels and fits the arms' spheres.
_START_S = 300.0
_HINT = "a new one is started"


class CameraProcess:
    """One camera process; after a loss, create another one."""

    def __init__(self) -> None:
        self._worker: WorkerProcess[ToCameras, FromCameras] | None = None
        self.words = ""

    @property
    def pid(self) -> int:
        """The process id, 0 while there is none."""
        return self._worker.pid if self._worker is not None else 0

    async def start(self, setup: PerceptionSetup) -> None:
        """Start the process and wait until it is ready.

        Raises:
            CellError: the cell cannot be rendered.
            RobotError: the process does not start.
        """
        worker = self._worker = WorkerProcess[ToCameras, FromCameras](
            _START, FromCameras, what=_WHAT, hint=_HINT, settings=_SETTINGS
        )
        try:
            await worker.start()
            async with asyncio.timeout(_START_S):
                ready = await asyncio.shield(worker.ask(setup).answer)
        except TimeoutError as error:
            self.end()
            raise RobotError(f"the camera process was not ready within {_START_S:g} s", hint=_HINT) from error
        except BaseException:
            # On any error, cancellation included, no process may be left behind.
            self.end()
            raise
        assert isinstance(ready, PerceptionReady)
        self.words = ready.words

    def know(self, known: KnownGeometry) -> None:
        """Exclude these obstacles and held parts from the next image on; a lost process does not hear it."""
        if self._worker is not None and not self._worker.lost_reason:
            self._worker.send(known)

    def change(self, setup: PerceptionSetup) -> None:
        """Take the fixtures and detectors of a setup from the next image on; a lost process does not hear it."""
        if self._worker is not None and not self._worker.lost_reason:
            self._worker.send(setup)

    async def look(self, request: PerceptionRequest) -> PerceptionResult:
        """Return the result.

        Raises:
            CellError: the request fails.
            RobotError: the process is lost, or becomes so.
        """
        if self._worker is None:
            raise RobotError("the camera process was ended", hint=_HINT)
        seen = await self._worker.ask(request).answer
        assert isinstance(seen, PerceptionResult)
        return seen

    def end(self) -> None:
        """End the process; it holds no state worth keeping."""
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.end()
