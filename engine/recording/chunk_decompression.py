"""Decompresses the chunks of a recording: never beyond their declared size, and never beyond the limit."""

from __future__ import annotations

import zlib
from importlib import import_module
from typing import Any

import zstandard
from mcap.records import Chunk

from engine.recording.read_budget import MAX_CHUNK, ReadBudget


def decompress_chunk(chunk: Chunk, allowance: ReadBudget) -> bytes:
    """Return the records in a chunk as bytes.

    Raises:
        ValueError: the chunk is too large, has an unknown compression, or is damaged.
    """
    allowance.take_chunk(chunk.uncompressed_size)
    data = _unpacked(chunk)
    if len(data) != chunk.uncompressed_size:
        raise ValueError(f"a chunk does not decompress to its declared {chunk.uncompressed_size} bytes")
    if chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc:
        raise ValueError("the checksum of a chunk is wrong")
    return data


def _unpacked(chunk: Chunk) -> bytes:
    # Request one byte more than declared, to detect excess data.
    limit = chunk.uncompressed_size + 1
    match chunk.compression:
        case "":
            return chunk.data
        case "zstd":
            reader = zstandard.ZstdDecompressor(max_window_size=MAX_CHUNK).stream_reader(chunk.data)
            return reader.read(limit)
        case "lz4":
            # It has no types.
            frame: Any = import_module("lz4.frame")
            return frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=limit)
        case other:
            raise ValueError(f"a chunk has the unknown compression {other[:20]!r}")
