"""Messages on a byte stream: four bytes of length, little endian, then that many bytes."""

from __future__ import annotations

from engine.errors import RobotError

_HEADER = 4
LARGEST_FRAME = 64 * 1024 * 1024


def frame_message(payload: bytes) -> bytes:
    """Return `payload` with its length in front."""
    if len(payload) > LARGEST_FRAME:
        raise RobotError(f"a message of {len(payload)} bytes exceeds the limit of {LARGEST_FRAME} bytes")
    return len(payload).to_bytes(_HEADER, "little") + payload


class FrameReader:
    """Splits a byte stream, fed in pieces of any size, into messages."""

    def __init__(self) -> None:
        self._waiting = bytearray()

    def feed(self, data: bytes) -> list[bytes]:
        """Take more bytes and return the messages that are now complete.

        Raises:
            RobotError: a length exceeds the limit; the stream is corrupt.
        """
        self._waiting += data
        messages: list[bytes] = []
        start = 0
        while len(self._waiting) - start >= _HEADER:
            length = int.from_bytes(self._waiting[start : start + _HEADER], "little")
            if length > LARGEST_FRAME:
                raise RobotError(
                    f"a message header states {length} bytes, above the limit of {LARGEST_FRAME}: the stream is corrupt"
                )
            end = start + _HEADER + length
            if len(self._waiting) < end:
                break
            messages.append(bytes(self._waiting[start + _HEADER : end]))
            start = end
        del self._waiting[:start]
        return messages
