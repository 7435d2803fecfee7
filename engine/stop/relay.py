"""The engine's side of the stop relay: starts its process, hands out stop lines, and hears of every stop."""

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
_WORDS_S = 0.2
_log = logging.getLogger("flexcell.stop")

StopCallback = Callable[[StopNotice], Awaitable[None]]


@dataclass(frozen=True, kw_only=True)
class StopEndpoint:
    """Where STOP is taken whatever the engine does: POST `{"token": …, "reason": …}` to `url`."""

    url: str
    token: str

    @property
    def origin(self) -> str:
        """The origin of `url`, as a browser has it."""
        parts = urlsplit(self.url)
        return f"{parts.scheme}://{parts.netloc}"


class StopRelay:
    """A stop that needs no event loop: `async with` starts the relay's process and ends it.

    Belongs to the event loop that enters it. Not a safety function: see docs/concepts/safety.md.

    Args:
        host: Loopback address to take STOP at over HTTP; None for signals only.
        port: TCP port; 0 takes a free one.
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
        self._carried_out: set[asyncio.Task[None]] = set()
        self._origins: tuple[str, ...] = ()
        self._watches_signals = False
        self._stops_at_signals = False
        self._when_connection_changes: list[Callable[[], None]] = []
        self._lost_reason = ""

    @property
    def lost_reason(self) -> str:
        """Why the relay is gone; empty while it works."""
        return self._lost_reason

    def when_connection_changes(self, tell: Callable[[], None]) -> None:
        """Call `tell`, on the event loop, when the relay is gone and when it is back."""
        self._when_connection_changes.append(tell)

    async def reconnect(self) -> str:
        """Start the relay's process again; devices need new lines, so they are connected again after it.

        Raises:
            RobotError: it does not start.
        """
        if self._lost_reason:
            self._end_process()
            await self._start()
            self._tell_connection()
        return ""

    @property
    def endpoint(self) -> StopEndpoint | None:
        """Where STOP is taken over HTTP; None where it is not."""
        if self._listener is None:
            return None
        host, port = self._listener.getsockname()[:2]
        return StopEndpoint(url=f"http://{host_in_url(host)}:{port}/stop", token=self._token)

    async def __aenter__(self) -> Self:
        """Start the process; raises FlexcellError when it does not start, or the port is taken."""
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
        """End the process; every line has been closed before, or is cut now."""
        self._callback = None
        for task in self._carried_out:
            task.cancel()
        if self._carried_out:
            await asyncio.wait(self._carried_out)
        self._send(CloseRelay())
        self._end()

    def kill(self) -> None:
        """End the relay's process at once, as a crash would; for tests and benchmarks."""
        if self._process is not None:
            self._process.kill()

    def on_stop(self, callback: StopCallback | None) -> None:
        """Call back with every stop that did not come from this engine; it has reached the devices already.

        What the callback raises is logged, and the devices stay latched; when it returns they are released.
        """
        self._callback = callback

    def allow_origins(self, origins: Iterable[str]) -> None:
        """Let pages of these origins, such as `http://127.0.0.1:8642`, read the answer to STOP."""
        self._origins = tuple(origins)
        self._configure()

    def new_line(self, device: str) -> socket.socket:
        """Return the device's end of a new stop line, to be handed to its process and closed here.

        Raises:
            CellError: the relay is gone.
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
            raise CellError(f"the stop relay takes no line: {error}", where=device) from error
        finally:
            ours.close()
        return theirs

    async def order(self, reason: str) -> int | None:
        """Have every device told to stop, and return the stop's number, for `release`; None where the relay is gone."""
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
        """Let devices that this stop, or an earlier one, has latched move again: what was under way has ended."""
        self._send(StopRelease(stop=stop))

    @contextmanager
    def watched_signals(self, *, at_once: bool = False) -> Generator[None]:
        """Have the relay see SIGINT and SIGTERM while the block runs, also while this interpreter is held.

        The relay stops the devices `at_once`, or when the event loop does not answer. Main thread only. The signals
        need handlers set by `signal.signal`: an event loop's own would take the descriptor that this needs.
        """
        assert self._signals is not None
        self._stops_at_signals = at_once
        self._configure()
        before = signal.set_wakeup_fd(self._signals.fileno(), warn_on_full_buffer=False)
        self._watches_signals = True
        try:
            yield
        finally:
            self._watches_signals = self._stops_at_signals = False
            signal.set_wakeup_fd(before)

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
            self._forget_control()
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
                task = asyncio.get_running_loop().create_task(self._carry_out(message), name=f"stop {message.stop}")
                self._carried_out.add(task)
                task.add_done_callback(self._carried_out.discard)
            case _:
                pass

    async def _carry_out(self, notice: StopNotice) -> None:
        _log.warning("STOP: %s", notice.reason)
        try:
            if self._callback is not None:
                await self._callback(notice)
        except FlexcellError as error:
            _log.error("after STOP the devices stay stopped: %s", error)
            return
        if notice.stop:
            self.release(notice.stop)

    def _lost(self) -> None:
        """Treat the loss of the relay as a stop: every device has found its line cut."""
        self._forget_control()
        reason = f"{_WHAT} has ended{_how(self._process)}"
        if self._ready is not None and not self._ready.done():
            self._ready.set_exception(RobotError(f"{reason} before it was ready"))
            return
        self._lost_reason = reason
        self._tell_connection()
        self._take(StopNotice(stop=0, reason=reason, source="loss"))

    def _tell_connection(self) -> None:
        for tell in self._when_connection_changes:
            tell()

    def _configure(self) -> None:
        settings = RelaySettings(token=self._token, origins=self._origins, stops_at_signals=self._stops_at_signals)
        self._send(settings)

    def _send(self, message: ToRelay) -> None:
        if self._outbox is not None:
            self._outbox.send(encode_message(message))

    def _forget_control(self) -> None:
        control, self._control = self._control, None
        outbox, self._outbox = self._outbox, None
        if control is not None and outbox is not None:
            asyncio.get_running_loop().remove_reader(control.fileno())
            outbox.close()
            control.close()

    def _end(self) -> None:
        self._lost_reason = self._lost_reason or "the stop relay was closed"
        self._forget_control()
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


def _how(process: subprocess.Popen[bytes] | None) -> str:
    """Say how the process ended; empty while it lives on with its end of the socket closed."""
    if process is None:
        return ""
    with suppress(subprocess.TimeoutExpired):
        return f" {exit_code_text(process.wait(timeout=_WORDS_S))}"
    return ""
