"""The client of the camera process on the event loop: starts it, sends requests, and never reuses a lost process."""

from __future__ import annotations

import asyncio
import socket
import subprocess
from collections.abc import Callable

import msgspec

from engine.errors import CellError, RobotError
from engine.host.child_process import describe_exit, start_child
from robots.io.framing import FrameReader, frame_message
from robots.vision.camera_process_messages import (
    FromWorker,
    PerceptionAnswer,
    PerceptionOrder,
    PerceptionReady,
    PerceptionRefusal,
    StartPerception,
    ToWorker,
    UpdateKnownGeometry,
)
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
        self._process: subprocess.Popen[bytes] | None = None
        self._wire: CameraConnection | None = None
        self._numbers = 0
        self.words = ""

    @property
    def pid(self) -> int:
        """The process id, 0 while there is none."""
        return self._process.pid if self._process is not None and self._process.poll() is None else 0

    async def start(self, sight: PerceptionSetup) -> None:
        """Start the process and wait until it is ready.

        Raises:
            CellError: the cell cannot be rendered.
            RobotError: the process does not start.
        """
        ours, theirs = socket.socketpair()
        try:
            self._process = start_child(_START, (theirs.fileno(),), what=_WHAT, settings=_SETTINGS)
            theirs.close()
            _, wire = await asyncio.get_running_loop().create_connection(
                lambda: CameraConnection(self._how_it_ended), sock=ours
            )
            self._wire = wire
            wire.send(StartPerception(sight=sight))
            async with asyncio.timeout(_START_S):
                self.words = (await asyncio.shield(wire.opened)).words
        except TimeoutError as error:
            self.end()
            raise RobotError(f"the camera process was not ready within {_START_S:g} s", hint=_HINT) from error
        except BaseException:
            # On any error, cancellation included, no process may be left behind.
            if self._wire is None:
                ours.close()
            self.end()
            raise
        finally:
            theirs.close()

    def know(self, known: KnownGeometry) -> None:
        """Exclude these obstacles and held parts from the next image on."""
        if self._wire is not None:
            self._wire.send(UpdateKnownGeometry(known=known))

    def ask(self, look: PerceptionRequest) -> asyncio.Future[PerceptionResult]:
        """Return the future result: CellError if the request fails, RobotError when the process is lost."""
        if self._wire is None:
            raise RobotError("the camera process was ended", hint=_HINT)
        self._numbers += 1
        return self._wire.ask(PerceptionOrder(number=self._numbers, look=look))

    def end(self) -> None:
        """End the process; it holds no state worth keeping."""
        wire, self._wire = self._wire, None
        if wire is not None:
            wire.close()
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()

    def _how_it_ended(self) -> str:
        return describe_exit(self._process, what=_WHAT)


class CameraConnection(asyncio.Protocol):
    """The client's end of the socket."""

    def __init__(self, how_it_ended: Callable[[], str]) -> None:
        loop = asyncio.get_running_loop()
        self._how_it_ended = how_it_ended
        self._reader = FrameReader()
        self._decode = msgspec.msgpack.Decoder(FromWorker).decode
        self._transport: asyncio.Transport | None = None
        self._asked: dict[int, asyncio.Future[PerceptionResult]] = {}
        self.opened: asyncio.Future[PerceptionReady] = loop.create_future()
        """Completes once the process is ready."""
        self._lost: RobotError | None = None

    def ask(self, order: PerceptionOrder) -> asyncio.Future[PerceptionResult]:
        """Send a request; raises RobotError when the process is lost."""
        future: asyncio.Future[PerceptionResult] = asyncio.get_running_loop().create_future()
        if self._lost is not None:
            raise self._lost
        self._asked[order.number] = future
        self.send(order)
        return future

    def send(self, message: ToWorker) -> None:
        """Send a message; messages to a lost process are dropped."""
        if self._lost is None and self._transport is not None:
            self._transport.write(frame_message(msgspec.msgpack.encode(message)))

    def close(self) -> None:
        """Close the connection."""
        if self._transport is not None:
            self._transport.close()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Start receiving; called by asyncio."""
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport

    def data_received(self, data: bytes) -> None:
        """Handle received data; called by asyncio."""
        try:
            for frame in self._reader.feed(data):
                self._take(self._decode(frame))
        except (RobotError, msgspec.MsgspecError) as error:
            # The stream is invalid: nothing after it can be decoded either.
            self._lose(RobotError(f"the camera process sent an invalid message: {error}", hint=_HINT))
            self.close()

    def connection_lost(self, exc: Exception | None) -> None:
        """Fail all waiters: the process is lost; called by asyncio."""
        self._lose(RobotError(self._how_it_ended(), hint=_HINT))

    def _take(self, message: FromWorker) -> None:
        match message:
            case PerceptionReady():
                if not self.opened.done():
                    self.opened.set_result(message)
            case PerceptionAnswer(number=number, seen=seen):
                future = self._asked.pop(number, None)
                if future is not None and not future.done():
                    future.set_result(seen)
            case PerceptionRefusal(number=number):
                future = self._asked.pop(number, None) if number else self.opened
                if future is not None and not future.done():
                    future.set_exception(
                        CellError(message.message, where=message.where or None, hint=message.hint or None)
                    )

    def _lose(self, error: RobotError) -> None:
        if self._lost is not None:
            return
        self._lost = error
        waiting = list(self._asked.values())
        self._asked.clear()
        for future in (self.opened, *waiting):
            if not future.done():
                future.set_exception(error)
                # The requester may be gone; then nobody else retrieves the exception.
                future.exception()
