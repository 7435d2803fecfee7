"""Frames on a byte stream: four bytes of length, four of the number of a request, little endian, then the payload."""

from __future__ import annotations

from struct import Struct

from engine.errors import RobotError

_HEADER = Struct("<II")
LARGEST_FRAME = 64 * 1024 * 1024

Frame = tuple[int, bytes]
"""The number of the request that a payload belongs to, 0 for none, and the payload."""


def frame_payload(payload: bytes, *, number: int = 0) -> bytes:
    """Return `payload` with its length and `number` in front."""
    if len(payload) > LARGEST_FRAME:
        raise RobotError(f"a message of {len(payload)} bytes exceeds the limit of {LARGEST_FRAME} bytes")
    return _HEADER.pack(len(payload), number) + payload


class FrameReader:
    """Splits a byte stream, fed in pieces of any size, into frames."""

    def __init__(self) -> None:
        self._waiting = bytearray()

    def feed(self, data: bytes) -> list[Frame]:
        """Take more bytes and return the frames that are now complete.

        Raises:
            RobotError: a length exceeds the limit; the stream is corrupt.
        """
        self._waiting += data
        frames: list[Frame] = []
        start = 0
        with memoryview(self._waiting) as waiting:
            while len(waiting) - start >= _HEADER.size:
                length, number = _HEADER.unpack_from(waiting, start)
                if length > LARGEST_FRAME:
                    raise RobotError(
                        f"a message header states {length} bytes, above the limit of {LARGEST_FRAME}: "
                        "the stream is corrupt"
                    )
                begin = start + _HEADER.size
                end = begin + length
                if len(waiting) < end:
                    break
                frames.append((number, bytes(waiting[begin:end])))
                start = end
        del self._waiting[:start]
        return frames
