"""The device's end of a stop line, polled by the process of a controller or driver in every cycle."""

from __future__ import annotations

import socket

import msgspec

from engine.stop.relay_messages import (
    MessageReader,
    StopAcknowledgement,
    StopNotice,
    StopRelease,
    ToDevice,
    encode_message,
)

_READ_BYTES = 4096
CUT = "the stop line is cut: the stop relay has ended"


class StopLine:
    """A latch that STOP sets and only a release by the engine clears.

    Belongs to the thread of the control loop. `poll` never blocks. A cut line counts as a stop that
    cannot be released: a broken connection must not leave a machine that cannot be stopped.

    Args:
        connection: The device's end, from `StopRelay.new_line`.
    """

    def __init__(self, connection: socket.socket) -> None:
        connection.setblocking(False)
        self._connection = connection
        self._reader = MessageReader(ToDevice)
        self._stop = 0
        self._rest_reported = True
        self._cut = False
        self.reason = ""
        """Why the line is latched; empty while it is not."""

    @property
    def latched(self) -> bool:
        """Whether no motion may start or continue."""
        return bool(self.reason)

    @property
    def cut(self) -> bool:
        """Whether the other end is closed: no STOP can arrive, so the process must end once everything is at rest."""
        return self._cut

    @property
    def awaits_rest(self) -> bool:
        """Whether the latest stop still awaits `report_at_rest`."""
        return not self._rest_reported

    def poll(self) -> str:
        """Read the line; return the reason of a stop that arrived since the last call: bring everything to rest now."""
        if self._cut:
            return ""
        stopped = ""
        try:
            while data := self._connection.recv(_READ_BYTES):
                for message in self._reader.feed(data):
                    stopped = self._take(message) or stopped
        except BlockingIOError:
            return stopped
        except (OSError, msgspec.DecodeError):
            # A line that is cut or carries invalid data cannot be trusted to deliver a stop.
            pass
        self._cut, self.reason = True, CUT
        return CUT

    def report_at_rest(self) -> None:
        """Report once for each stop that everything is at rest; call it in every cycle at rest."""
        if not self._rest_reported:
            self._rest_reported = True
            self._send(StopAcknowledgement(stop=self._stop, at_rest=True))

    def _take(self, message: object) -> str:
        match message:
            case StopNotice():
                self._stop, self._rest_reported = message.stop, False
                self.reason = message.reason or "STOP"
                self._send(StopAcknowledgement(stop=message.stop, at_rest=False))
                return self.reason
            case StopRelease() if message.stop >= self._stop:
                self.reason = ""
            case _:
                pass
        return ""

    def _send(self, message: StopAcknowledgement) -> None:
        try:
            self._connection.send(encode_message(message))
        except OSError:
            # The other end is closed; the next `poll` finds the line cut.
            return
