"""The protocol of the emulated board, one session a connection: lines, of the sketch or of one without answers."""

from __future__ import annotations

from robots.drivers.servo_arm.emulation.emulated_board import EmulatedBoard, angles_of

_LONGEST = 256


class BoardPower:
    """Whether the board has started: until then it ignores what it receives."""

    def __init__(self) -> None:
        self.on = True


class BoardSession:
    """Lines of one connection."""

    def __init__(self, board: EmulatedBoard, power: BoardPower, *, answers: bool) -> None:
        self._board = board
        self._power = power
        self._answers = answers
        self._buffer = b""

    def feed(self, received: bytes) -> bytes:
        """Answer all complete lines."""
        if not self._power.on:
            self._buffer = b""
            return b""
        *lines, self._buffer = (self._buffer + received).replace(b"\r", b"").split(b"\n")
        self._buffer = self._buffer[:_LONGEST]
        if self._answers:
            return b"".join(self._board.execute(line) for line in lines)
        for line in lines:
            angles = angles_of(line)
            if len(angles) == self._board.servos:
                self._board.follow(angles)
        return b""
