"""The engine's side of the stop relay: starts its process, creates stop lines, and receives every stop."""

from __future__ import annotations

import asyncio
import logging
import secrets
import signal
import socket
import subprocess
from collections.abc import Awaitable, Callable, Generator, Iterable
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from types import TracebackType
from typing import Self
from urllib.parse import urlsplit

from engine.errors import CONNECT_AGAIN, CellError, FlexcellError, RobotError
from engine.host.child_process import exit_code_text, start_child
from engine.host.loopback import bound_socket, host_in_url
from engine.stop.outbox import Outbox
from engine.stop.relay_messages import (
    CloseRelay,
    EngineProbe,
    FromRelay,
    MessageReader,
    NewStopLine,
    ProbeReply,
    RelayReady,
    RelaySettings,
    StopCommand,
    StopCommandReply,
    StopNotice,
    StopRelease,
    ToRelay,
    encode_message,
)

_START = "from engine.stop.relay_process import main; main()"
_WHAT = "the stop relay"
_START_S = 20.0
_ORDER_S = 0.3
_END_S = 2.0
_EXIT_TIMEOUT_S = 0.2
_log = logging.getLogger("flexcell.stop")

StopCallback = Callable[[StopNotice], Awaitable[None]]


@dataclass(frozen=True, kw_only=True)
class StopEndpoint:
    """The address of STOP, independent of the engine: POST `{"token": …, "reason": …}` to `url`."""

    url: str
    token: str

    @property
    def origin(self) -> str:
        """The origin of `url`, as a browser writes it."""
        parts = urlsplit(self.url)
        return f"{parts.scheme}://{parts.netloc}"


class StopRelay:
    """A stop that needs no event loop of the engine: `async with` starts the relay's process and ends it.

    Belongs to the event loop that enters it. Not a safety function: see docs/concepts/safety.md.

    Args:
        host: Loopback address of STOP over HTTP; None for signals only.
        port: TCP port; 0 selects a free one.
    """

    def __init__(self, *, host: str | None = None, port: int = 0) -> None:
        self._host = host
        self._port = port
        self._token = secrets.token_urlsafe(32)
        self._listener: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._control: socket.socket | None = None
        self._signals: socket.socket | None = None
        self._reader = MessageReader(FromRelay)
        self._outbox: Outbox | None = None
        self._ready: asyncio.Future[None] | None = None
        self._orders: dict[int, asyncio.Future[int]] = {}
        self._requests = 0
        self._callback: StopCallback | None = None
        self._stop_tasks: set[asyncio.Task[None]] = set()
        self._origins: tuple[str, ...] = ()
        self._watches_signals = False
        self._stops_at_signals = False
        self._when_connection_changes: list[Callable[[], None]] = []
        self._lost_reason = ""

    @property
    def lost_reason(self) -> str:
        """Why the relay has ended; empty while it works."""
        return self._lost_reason

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when the relay has ended and when it is reconnected."""
        self._when_connection_changes.append(callback)

    async def reconnect(self) -> str:
        """Start the relay's process again; devices need new lines, so they are reconnected afterwards.

        Raises:
            RobotError: the process does not start.
        """
        if self._lost_reason:
            self._end_process()
            await self._start()
            self._notify_connection()
        return ""

    @property
    def endpoint(self) -> StopEndpoint | None:
        """The address of STOP over HTTP; None when there is none."""
        if self._listener is None:
            return None
        host, port = self._listener.getsockname()[:2]
        return StopEndpoint(url=f"http://{host_in_url(host)}:{port}/stop", token=self._token)

    async def __aenter__(self) -> Self:
        """Start the process; raises FlexcellError when it does not start or the port is in use."""
        if self._host is not None:
            self._listener = bound_socket(self._host, self._port, option="--stop-port")
        try:
            await self._start()
        except BaseException:
            self._end()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the process; lines that are still open are cut."""
        self._callback = None
        for task in self._stop_tasks:
            task.cancel()
        if self._stop_tasks:
            await asyncio.wait(self._stop_tasks)
        self._send(CloseRelay())
        self._end()

    def kill(self) -> None:
        """Kill the relay's process, as a crash would; for tests and benchmarks."""
        if self._process is not None:
            self._process.kill()

    def on_stop(self, callback: StopCallback | None) -> None:
        """Call `callback` with every stop from another source; the devices have already received it.

        An error of the callback is logged, and the devices stay latched; when it returns they are released.
        """
        self._callback = callback

    def allow_origins(self, origins: Iterable[str]) -> None:
        """Allow pages of these origins, such as `http://127.0.0.1:8642`, to read the response to STOP."""
        self._origins = tuple(origins)
        self._configure()

    def new_line(self, device: str) -> socket.socket:
        """Return the device's end of a new stop line; the caller passes it to the device's process and closes it here.

        Raises:
            CellError: the relay has ended or does not read its messages.
        """
        if self._control is None or self._outbox is None:
            raise CellError(self._lost_reason or "the stop relay is not open", where=device, hint=CONNECT_AGAIN)
        ours, theirs = socket.socketpair()
        try:
            self._outbox.send()
            if not self._outbox.empty:
                raise BlockingIOError("it does not read its messages")
            socket.send_fds(self._control, [encode_message(NewStopLine(device=device))], [ours.fileno()])
        except OSError as error:
            theirs.close()
            raise CellError(f"the stop relay accepts no stop line: {error}", where=device) from error
        finally:
            ours.close()
        return theirs

    async def order(self, reason: str) -> int | None:
        """Send a stop to every device and return its number, for `release`; None when the relay has ended."""
        if self._control is None:
            return None
        self._requests += 1
        request = self._requests
        ordered = self._orders[request] = asyncio.get_running_loop().create_future()
        self._send(StopCommand(reason=reason, request=request))
        try:
            async with asyncio.timeout(_ORDER_S):
                return await ordered
        except TimeoutError:
            _log.error("the stop relay does not answer; the robots are stopped without it")
            return None
        finally:
            self._orders.pop(request, None)

    def release(self, stop: int) -> None:
        """Unlatch devices that this stop or an earlier one has latched; call it when the stopped runs have ended."""
        self._send(StopRelease(stop=stop))

    @contextmanager
    def watched_signals(self, *, at_once: bool = False) -> Generator[None]:
        """Report SIGINT and SIGTERM to the relay while the block runs, also while this interpreter is blocked.

        The relay stops the devices `at_once`, or when the event loop does not answer. Main thread only. The signals
        need handlers set by `signal.signal`: those of an event loop would use the wakeup descriptor needed here.
        """
        assert self._signals is not None
        self._stops_at_signals = at_once
        self._configure()
        previous_fd = signal.set_wakeup_fd(self._signals.fileno(), warn_on_full_buffer=False)
        self._watches_signals = True
        try:
            yield
        finally:
            self._watches_signals = self._stops_at_signals = False
            signal.set_wakeup_fd(previous_fd)

    async def _start(self) -> None:
        control, theirs = socket.socketpair()
        signals, signals_theirs = socket.socketpair()
        for each in (control, signals):
            each.setblocking(False)
        http = (self._listener.fileno(),) if self._listener is not None else ()
        try:
            self._process = start_child(_START, (theirs.fileno(), signals_theirs.fileno(), *http), what=_WHAT)
        finally:
            theirs.close()
            signals_theirs.close()
        self._control, self._signals = control, signals
        self._outbox, self._reader = Outbox(control), MessageReader(FromRelay)
        loop = asyncio.get_running_loop()
        self._ready = loop.create_future()
        loop.add_reader(control.fileno(), self._read)
        self._configure()
        if self._watches_signals:
            signal.set_wakeup_fd(signals.fileno(), warn_on_full_buffer=False)
        try:
            async with asyncio.timeout(_START_S):
                await self._ready
        except TimeoutError as error:
            self._close_control()
            raise RobotError(f"{_WHAT} does not answer within {_START_S:g} s") from error
        self._lost_reason = ""

    def _read(self) -> None:
        assert self._control is not None
        messages, is_over = self._reader.receive(self._control)
        for message in messages:
            self._take(message)
        if is_over:
            self._lost()

    def _take(self, message: object) -> None:
        match message:
            case RelayReady():
                if self._ready is not None and not self._ready.done():
                    self._ready.set_result(None)
            case EngineProbe():
                self._send(ProbeReply(number=message.number))
            case StopCommandReply():
                ordered = self._orders.get(message.request)
                if ordered is not None and not ordered.done():
                    ordered.set_result(message.stop)
            case StopNotice():
                task = asyncio.get_running_loop().create_task(self._execute_stop(message), name=f"stop {message.stop}")
                self._stop_tasks.add(task)
                task.add_done_callback(self._stop_tasks.discard)
            case _:
                pass

    async def _execute_stop(self, notice: StopNotice) -> None:
        _log.warning("STOP: %s", notice.reason)
        try:
            if self._callback is not None:
                await self._callback(notice)
        except FlexcellError as error:
            _log.error("the devices stay latched after STOP: %s", error)
            return
        if notice.stop:
            self.release(notice.stop)

    def _lost(self) -> None:
        """Treat the loss of the relay as a stop: the line of every device is cut."""
        self._close_control()
        reason = f"{_WHAT} has ended{_exit_text(self._process)}"
        if self._ready is not None and not self._ready.done():
            self._ready.set_exception(RobotError(f"{reason} before it was ready"))
            return
        self._lost_reason = reason
        self._notify_connection()
        self._take(StopNotice(stop=0, reason=reason, source="loss"))

    def _notify_connection(self) -> None:
        for callback in self._when_connection_changes:
            callback()

    def _configure(self) -> None:
        settings = RelaySettings(token=self._token, origins=self._origins, stops_at_signals=self._stops_at_signals)
        self._send(settings)

    def _send(self, message: ToRelay) -> None:
        if self._outbox is not None:
            self._outbox.send(encode_message(message))

    def _close_control(self) -> None:
        control, self._control = self._control, None
        outbox, self._outbox = self._outbox, None
        if control is not None and outbox is not None:
            asyncio.get_running_loop().remove_reader(control.fileno())
            outbox.close()
            control.close()

    def _end(self) -> None:
        self._lost_reason = self._lost_reason or "the stop relay was closed"
        self._close_control()
        if self._listener is not None:
            self._listener.close()
        self._end_process()

    def _end_process(self) -> None:
        if self._signals is not None:
            self._signals.close()
        process, self._process = self._process, None
        if process is not None:
            with suppress(subprocess.TimeoutExpired):
                process.wait(timeout=_END_S)
            if process.poll() is None:
                process.kill()
                process.wait()


def _exit_text(process: subprocess.Popen[bytes] | None) -> str:
    """Return how the process ended; empty while it still runs with its end of the socket closed."""
    if process is None:
        return ""
    with suppress(subprocess.TimeoutExpired):
        return f" {exit_code_text(process.wait(timeout=_EXIT_TIMEOUT_S))}"
    return ""
