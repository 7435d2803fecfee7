"""A switch behind plain texts on a port of its own: one output, confirmed by a reply where there is one."""

from __future__ import annotations

import asyncio
import threading
from contextlib import suppress

from engine.errors import RobotError
from robots.drivers.abb.abb_faults import REMEDIES, AbbFault, AbbLinkError
from robots.drivers.abb.abb_options import GripperStrings
from robots.drivers.abb.state_transport import connected
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

_READ_BYTES = 256


class GripperSwitch:
    """Implements `robots.port.OutputPort` and `ConfirmedOutputs` with output 0.

    Its value is the last one that was confirmed, or sent where no reply is expected; off before the first. It is
    connected by `connect` only, so that nothing is switched after a lost connection before a person permits it.

    Args:
        host: Where the controller is.
        strings: The port and its texts.
        timeout_s: Time limit of connecting.
        tap: Notes the bytes of the connection.
    """

    def __init__(self, host: str, strings: GripperStrings, *, timeout_s: float, tap: WireTap = NO_TAP) -> None:
        self._where = (host, strings.port)
        self._strings = strings
        self._timeout_s = timeout_s
        self._tap = tap
        self._socket: TcpConnection | None = None
        self._lost = "motion is not enabled"
        self._on = False
        self._unconfirmed: bool | None = None
        self._receiving = False
        # Who connects is in another thread than who disconnects.
        self._lock = threading.Lock()
        self._closes = 0

    @property
    def values(self) -> tuple[bool, ...]:
        """The value of the switch."""
        return (self._on,)

    def connect(self) -> None:
        """Connect anew; blocks for the time limit at most, and raises RobotError, also if it is closed meanwhile."""
        self.close("not connected")
        closes = self._closes
        try:
            connection = connected(self._where, self._timeout_s, self._tap)
        except AbbLinkError as error:
            self._lost = str(error)
            raise self._error(self._lost, REMEDIES[error.fault]) from error
        # Before the event loop has it, which must not wait for it.
        connection.set_timeout(0.0)
        with self._lock:
            if self._closes == closes:
                self._socket = connection
                return
        connection.close()
        raise self._error(f"the switch was given up while it was connected: {self._lost}", "clear the cause first")

    def close(self, reason: str) -> None:
        """Disconnect; the switch keeps its value."""
        with self._lock:
            connection, self._socket = self._socket, None
            self._closes += 1
            self._lost, self._unconfirmed = reason, None
        if connection is not None:
            connection.shut_down()
            if not self._receiving:
                connection.close()

    def set(self, output: int, *, on: bool) -> None:
        """Send the text; where a reply is expected, `confirmed` waits for it.

        Raises:
            RobotError: there is no such output, or no connection.
        """
        if output != 0:
            raise self._error(f"there is no output {output}", "the gripper is output 0")
        try:
            self._send(self._strings.on if on else self._strings.off)
        except AbbLinkError as error:
            raise self._refused(on, error) from error
        if self._strings.reply == "none":
            self._on = on
        else:
            self._unconfirmed = on

    async def confirmed(self) -> None:
        """Return when the reply to the last text has come.

        Raises:
            RobotError: no reply came in time, or another one; a person has to enable motion again.
        """
        on, self._unconfirmed = self._unconfirmed, None
        if on is None:
            return
        try:
            async with asyncio.timeout(self._strings.reply_s):
                reply = await self._receive()
        except TimeoutError:
            missing = AbbLinkError(AbbFault.SILENT, f"no reply within {self._strings.reply_s:g} s")
            raise self._refused(on, missing) from None
        except AbbLinkError as error:
            raise self._refused(on, error) from error
        if self._strings.reply not in ("any", reply):
            other = AbbLinkError(AbbFault.REFUSED, f"the reply was {reply[:80]!r}, expected {self._strings.reply!r}")
            raise self._refused(on, other)
        self._on = on

    def _send(self, text: str) -> None:
        """Send a text, and drop late replies to earlier ones: they have no number."""
        connection = self._socket
        if connection is None:
            raise AbbLinkError(AbbFault.LINK_CUT, self._lost)
        try:
            with suppress(BlockingIOError):
                if not connection.receive(_READ_BYTES):
                    raise AbbLinkError(AbbFault.LINK_CUT, "the controller closed the connection")
            connection.send(f"{text}{self._strings.end}".encode())
        except OSError as error:
            raise AbbLinkError(AbbFault.LINK_CUT, f"the connection failed: {error.strerror or error}") from error

    async def _receive(self) -> str:
        """Return the reply: what comes first, and all of it where its text is known."""
        connection, expected, received = self._socket, self._strings.reply, b""
        if connection is None:
            raise AbbLinkError(AbbFault.LINK_CUT, self._lost)
        self._receiving = True
        try:
            while True:
                packet = await connection.receive_next(_READ_BYTES)
                if not packet:
                    reason = self._lost if self._socket is None else "the controller closed the connection"
                    raise AbbLinkError(AbbFault.LINK_CUT, reason)
                received += packet
                text = received.decode("ascii", errors="replace").strip()
                if expected == "any" or not expected.startswith(text) or text == expected:
                    return text
        except OSError as error:
            raise AbbLinkError(AbbFault.LINK_CUT, f"the connection failed: {error.strerror or error}") from error
        finally:
            self._receiving = False
            if self._socket is not connection:
                connection.close()  # it was given up meanwhile, and could not be closed while it was read

    def _refused(self, on: bool, error: AbbLinkError) -> RobotError:  # noqa: FBT001
        """Disconnect, and return what to raise."""
        self.close(str(error))
        text = self._strings.on if on else self._strings.off
        hint = "look at the gripper, then call enable_device"
        return self._error(f"{text} was not confirmed: {error}; the gripper may have switched", hint)

    def _error(self, message: str, hint: str) -> RobotError:
        return RobotError(message, where=f"{self._where[0]}:{self._where[1]}", hint=hint)
