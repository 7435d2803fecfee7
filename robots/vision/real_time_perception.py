"""The cameras in real time: a separate process renders one instant at a time; missed instants are dropped."""

from __future__ import annotations

import asyncio
from types import TracebackType
from typing import Self

from engine.errors import CellError, FlexcellError, RobotError
from engine.robot import DeviceStatus
from robots.sim.world.sim_world import SimWorld
from robots.vision.camera_process import CameraProcess
from robots.vision.cameras.camera import CameraSpec
from robots.vision.perception_device import PerceptionDevice
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup

_PATIENCE_S = 5.0
_LOOK_AFTER_S = 0.25
_FIRST_PAUSE_S, _LONGEST_PAUSE_S = 0.2, 10.0


class RealTimePerception(PerceptionDevice):
    """Keeps a camera process running and sends it requests on demand.

    If the process dies or hangs, the map is stale, with the reason, until the first result of a new process.
    """

    def __init__(self, setup: PerceptionSetup, *, world: SimWorld) -> None:
        super().__init__(setup, world=world, now_s=lambda: asyncio.get_running_loop().time())
        self._process = CameraProcess()
        self._sent_setup = setup
        self._task: asyncio.Task[None] | None = None
        self._fastest_s = min(1.0 / camera.rate_hz for camera in setup.cameras)
        self._due_s = dict.fromkeys((camera.name for camera in setup.cameras), 0.0)

    @property
    def pid(self) -> int:
        """The id of the camera process, 0 while there is none."""
        return self._process.pid

    async def __aenter__(self) -> Self:
        self.status = DeviceStatus.CONNECTED
        self.map.starting = True
        # In the background: the process takes seconds to start, and most work of a cell needs no cameras.
        self._task = asyncio.get_running_loop().create_task(self._watch(), name="cameras")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        task, self._task = self._task, None
        if task is not None:
            task.cancel()
            await asyncio.wait((task,))
        self._process.end()
        self.detections.fail("the cell is closed")
        self.status = DeviceStatus.DISCONNECTED

    async def _watch(self) -> None:
        pause_s = _FIRST_PAUSE_S
        while True:
            try:
                self._sent_setup = self.setup
                await self._process.start(self._sent_setup)
                self.set_rendering(self._process.words)
                self._has_started()
                self.restart_revisions()
                self.status = DeviceStatus.READY
                await self._look_on()
            except FlexcellError as error:
                self._process.end()
                self._has_started()
                pause_s = _FIRST_PAUSE_S if self.status is DeviceStatus.READY else min(2.0 * pause_s, _LONGEST_PAUSE_S)
                self.fail(str(error))
                await asyncio.sleep(pause_s)

    def _has_started(self) -> None:
        """Mark the start as finished, successful or not."""
        self.map.starting = False
        self.map.notify()

    async def _look_on(self) -> None:
        """Send requests whenever they are due; raises RobotError once the process is lost."""
        loop, sent = asyncio.get_running_loop(), None
        while True:
            now_s = loop.time()
            await asyncio.sleep(self._fastest_s - now_s % self._fastest_s)
            self.map.notify()
            if not self.needed:
                continue
            if self.setup is not self._sent_setup:
                self._sent_setup = self.setup
                self._process.change(self.setup)
            if self.known is not None and self.known is not sent:
                sent = self.known
                self._process.know(sent)
            looked_at_s = loop.time()
            order = self.next_look(self._due(looked_at_s), now_s=looked_at_s)
            if order is not None:
                try:
                    self.take_result(await self._seen(order), looked_at_s=looked_at_s)
                except CellError as error:
                    # The process works; the known geometry it received is invalid, and may be corrected.
                    self.fail(str(error))
                self.dropped += int((loop.time() - looked_at_s) / self._fastest_s)

    def _due(self, now_s: float) -> tuple[CameraSpec, ...]:
        found: list[CameraSpec] = []
        for camera in self.setup.cameras:
            # A quarter of a period early is on time: timers are irregular.
            if now_s >= self._due_s[camera.name] - 0.25 / camera.rate_hz:
                self._due_s[camera.name] = max(self._due_s[camera.name], now_s - 0.5 / camera.rate_hz)
                self._due_s[camera.name] += 1.0 / camera.rate_hz
                found.append(camera)
        return tuple(found)

    async def _seen(self, order: PerceptionRequest) -> PerceptionResult:
        """Return the result; meanwhile subscribers are notified of the map's age."""
        answer = asyncio.ensure_future(self._process.look(order))
        try:
            waited_s = 0.0
            while not answer.done() and waited_s < _PATIENCE_S:
                await asyncio.wait((answer,), timeout=_LOOK_AFTER_S)
                waited_s += _LOOK_AFTER_S
                self.map.notify()
            if not answer.done():
                raise RobotError(
                    f"the camera process has not answered within {_PATIENCE_S:g} s", hint="a new one is started"
                )
            return answer.result()
        finally:
            answer.cancel()
