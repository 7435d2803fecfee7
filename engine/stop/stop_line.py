"""The device's end of a stop line: what the process of a controller or driver looks at in every cycle."""

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
    """A latch that STOP closes and only the engine's release opens.

    Belongs to the thread of the control loop. `poll` never waits. A line that is cut counts as a stop, which
    nothing releases: a broken wire must not leave a machine that cannot be stopped.

    Args:
        connection: The device's end, from `StopRelay.new_line`.
    """

    def __init__(self, connection: socket.socket) -> None:
        connection.setblocking(False)
        self._connection = connection
        self._reader = MessageReader(ToDevice)
        self._stop = 0
        self._rest_told = True
        self._cut = False
        self.reason = ""
        """Why the latch is closed; empty while it is open."""

    @property
    def latched(self) -> bool:
        """Whether no motion may start or go on."""
        return bool(self.reason)

    @property
    def cut(self) -> bool:
        """Whether the other end is gone: no STOP can come any more, so the process is to end, once all rests."""
        return self._cut

    @property
    def awaits_rest(self) -> bool:
        """Whether somebody still waits to hear, by `report_at_rest`, that everything has come to rest."""
        return not self._rest_told

    def poll(self) -> str:
        """Read the line; the reason when a stop has arrived since the last call: bring everything to rest now."""
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
            # What is cut or speaks nonsense can no longer be trusted to bring a stop.
            pass
        self._cut, self.reason = True, CUT
        return CUT

    def report_at_rest(self) -> None:
        """Say, once for each stop, that everything has come to rest; called in every cycle in which it has."""
        if not self._rest_told:
            self._rest_told = True
            self._send(StopAcknowledgement(stop=self._stop, at_rest=True))

    def _take(self, message: object) -> str:
        match message:
            case StopNotice():
                self._stop, self._rest_told = message.stop, False
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
            # Whoever does not read any more has no need of it; the next `poll` finds the line cut.
            return
