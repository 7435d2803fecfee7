"""The protocol of the emulated hand, one session a connection."""

from __future__ import annotations

from robots.drivers.softhand.emulation.emulated_hand import EmulatedHand
from robots.drivers.softhand.hand_frames import (
    MOTORS_ON,
    ChecksumError,
    HandCommandCode,
    HandFrame,
    decode_words,
    encode_frame,
    encode_words,
    take_frame,
)

_BROADCAST = 0


class HandWire:
    """What all connections of a hand share: its address, and whether its checksums are wrong."""

    def __init__(self, hand: EmulatedHand, *, unit: int) -> None:
        self.hand = hand
        self.unit = unit
        self.wrong_checksum = False


class HandSession:
    """Frames of one connection; what has a wrong checksum or another address is ignored, as the firmware does."""

    def __init__(self, wire: HandWire) -> None:
        self._wire = wire
        self._buffer = bytearray()

    def feed(self, received: bytes) -> bytes:
        """Answer all complete requests."""
        self._buffer.extend(received)
        replies = b""
        while True:
            try:
                frame = take_frame(self._buffer)
            except ChecksumError:
                continue
            if frame is None:
                break
            replies += self._answer(frame)
        return replies

    def _answer(self, frame: HandFrame) -> bytes:
        wire, hand = self._wire, self._wire.hand
        if frame.unit not in (wire.unit, _BROADCAST):
            return b""
        match frame.command:
            case HandCommandCode.PING:
                data = b""
            case HandCommandCode.ACTIVATE:
                if len(frame.data) == 1:
                    hand.activate(on=frame.data == MOTORS_ON)
                return b""
            case HandCommandCode.SET_INPUTS:
                if len(frame.data) == len(encode_words(0, 0)):
                    hand.follow(decode_words(frame.data, 2)[0])
                return b""
            case HandCommandCode.GET_ACTIVATE:
                data = MOTORS_ON if hand.active else b"\0"
            case HandCommandCode.GET_INPUTS:
                data = encode_words(hand.reference_ticks, 0)
            case HandCommandCode.GET_MEASUREMENTS:
                data = encode_words(hand.position_ticks, 0, 0)
            case HandCommandCode.GET_CURRENTS:
                data = encode_words(hand.current_ma, 0)
            case HandCommandCode.GET_CURRENTS_AND_MEASUREMENTS:
                data = encode_words(hand.current_ma, 0, hand.position_ticks, 0, 0)
            case _:
                return b""
        reply = encode_frame(HandFrame(unit=wire.unit, command=frame.command, data=data))
        return reply[:-1] + bytes((reply[-1] ^ 0xFF,)) if wire.wrong_checksum else reply
