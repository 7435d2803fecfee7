"""A SoftHand on a serial line: three requests for a reading; commands have no answer."""

from __future__ import annotations

import time

from robots.drivers.softhand.hand_frames import (
    MOTORS_OFF,
    MOTORS_ON,
    ChecksumError,
    HandCommandCode,
    HandFrame,
    decode_words,
    encode_frame,
    encode_words,
    take_frame,
)
from robots.drivers.softhand.hand_reading import HandActivation, HandCommand, HandReading, HandReference
from robots.io.wire.link_error import LinkError
from robots.io.wire.serial_stream import SerialStream, shown
from robots.io.wire.wire_tap import NO_TAP, WireTap

_KEPT_BYTES = 512


class HandTransport:
    """Implements `DeviceTransport` for a hand with the address `unit`.

    Args:
        line: The serial line.
        unit: Address of the hand.
        timeout_s: Time limit of each request.
        tap: Notes the bytes of the line.
    """

    def __init__(self, device: str, *, baud: int, unit: int, timeout_s: float, tap: WireTap = NO_TAP) -> None:
        self._line = SerialStream(device, baud=baud, timeout_s=timeout_s, tap=tap)
        self._unit = unit
        self._timeout_s = timeout_s
        self._failed = False
        self._before_ticks: int | None = None

    @property
    def address(self) -> str:
        """The serial device."""
        return self._line.device

    @property
    def remedy(self) -> str:
        """What to check when it does not answer."""
        return f"check supply, cable, `device`, `baud` and unit {self._unit} of the hand"

    def open(self) -> None:
        """Connect; commands nothing."""
        self._line.open()
        if self._failed:
            self._line.drain()
            self._failed = False

    def close(self) -> None:
        """Disconnect."""
        self._line.close()

    def read(self) -> HandReading:
        """Ask whether the motor is on, for the reference, and for current and position."""
        (active,) = self._ask(HandCommandCode.GET_ACTIVATE, 1)
        reference = self._reference()
        both = self._ask(HandCommandCode.GET_CURRENTS_AND_MEASUREMENTS, 10)
        current, _, position, _, _ = decode_words(both, 5)
        before, self._before_ticks = self._before_ticks, None
        return HandReading(
            active=bool(active),
            reference_ticks=reference,
            before_ticks=reference if before is None else before,
            position_ticks=position,
            current_ma=current,
        )

    def write(self, command: HandCommand) -> None:
        """Send a command; the next reading has its effect.

        The reference before it is read first: one of another client would else be lost unnoticed.
        """
        match command:
            case HandReference(ticks=ticks):
                self._before_ticks = self._reference()
                self._send(HandCommandCode.SET_INPUTS, encode_words(ticks, 0))
            case HandActivation(on=on):
                self._send(HandCommandCode.ACTIVATE, MOTORS_ON if on else MOTORS_OFF)

    def _reference(self) -> int:
        return decode_words(self._ask(HandCommandCode.GET_INPUTS, 4), 2)[0]

    def _send(self, command: HandCommandCode, data: bytes = b"") -> None:
        self._line.write(encode_frame(HandFrame(unit=self._unit, command=command, data=data)))

    def _ask(self, command: HandCommandCode, count: int) -> bytes:
        """Return the data of the answer to a request, `count` bytes."""
        self._send(command)
        limit_s = time.monotonic() + self._timeout_s
        buffer, received = bytearray(), b""
        while time.monotonic() < limit_s and len(received) < _KEPT_BYTES:
            arrived = self._line.read(limit_s)
            received += arrived
            buffer.extend(arrived)
            while (frame := self._frame(buffer)) is not None:
                # Others on the line are not meant for us.
                if (frame.unit, frame.command, len(frame.data)) == (self._unit, command, count):
                    return frame.data
        self._failed = True
        garbage = f", but bytes that are no answer: {shown(received)}" if received else ""
        raise LinkError(f"no valid answer to {command.name} within {self._timeout_s:g} s{garbage}")

    def _frame(self, buffer: bytearray) -> HandFrame | None:
        try:
            return take_frame(buffer)
        except ChecksumError:
            self._failed = True
            raise
