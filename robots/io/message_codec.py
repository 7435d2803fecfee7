"""Messages as bytes: msgpack, with arrays as shape and float64 row-major bytes."""

from __future__ import annotations

from collections.abc import Callable
from math import prod
from types import UnionType
from typing import Any, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

Received = TypeVar("Received")


def encode_payload(message: object) -> bytes:
    """Return a message as bytes; its arrays must hold numbers.

    Raises:
        NotImplementedError: a field is neither data nor an array.
    """
    return _encoder.encode(message)


def payload_decoder(received: type[Received] | UnionType) -> Callable[[bytes], Received]:
    """Return the function that decodes a type or a union of types.

    Arrays arrive as new float64 arrays that may be changed. The function raises msgspec.MsgspecError for what is no
    message of these types.
    """
    decode: Callable[[bytes], Received] = msgspec.msgpack.Decoder(received, dec_hook=_array_of).decode
    return decode


def _plain(value: object) -> tuple[tuple[int, ...], memoryview]:
    if not isinstance(value, np.ndarray):
        raise NotImplementedError(f"{type(value).__name__} cannot be sent to another process")
    numbers: NDArray[np.float64] = np.asarray(value, dtype=np.float64, order="C")
    return numbers.shape, numbers.data


def _array_of(kind: type, data: Any) -> NDArray[np.float64]:
    """Return the array that `_plain` has sent; msgspec reports TypeError and ValueError as an invalid message."""
    if getattr(kind, "__origin__", kind) is not np.ndarray:
        raise NotImplementedError(f"{kind} cannot be received from another process")
    shape, numbers = data
    # A negative length would be taken for an unknown one.
    if 8 * prod(shape) != len(numbers):
        raise ValueError(f"{len(numbers)} bytes are no array of shape {shape}")
    # Copied: compiled functions are compiled once more for arrays that cannot be written.
    return np.frombuffer(numbers, dtype=np.float64).reshape(shape).copy()


_encoder = msgspec.msgpack.Encoder(enc_hook=_plain)
