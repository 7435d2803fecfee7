"""Description of the recorded run: everything required to replay it."""

from __future__ import annotations

import platform
import zlib
from collections.abc import Mapping
from importlib.metadata import version
from typing import Literal

import msgspec

from engine.errors import RecordingError
from engine.runtime.run_options import RunOptions

FORMAT = 1
RECORD_NAME = "flexcell"
"""Name of the MCAP metadata record of the description."""
_CHECKSUM = "crc32"


class RecordingDescription(msgspec.Struct, frozen=True, kw_only=True):
    """One run: behavior, parameters and inputs, clock, recording options."""

    format: int = FORMAT
    run: str
    behavior: str
    document: str
    """The meaning hash of the behavior."""
    behavior_file: str
    """The attachment with the behavior; the others are the documents that it references."""
    cell_file: str = ""
    meshes: dict[str, str] = {}
    """The SHA-256 of the mesh files of the cell, by the names that it has for them."""
    parameters: dict[str, object] = {}
    inputs: dict[str, object] = {}
    seed: int = 0
    clock: Literal["virtual", "real"]
    supervision: RunOptions = RunOptions()
    """The supervision of the run at its start."""
    started_unix_s: float = 0.0
    epoch_ns: int = 0
    """The run's time 0 in file time: 0 on a virtual clock, the wall clock time on a real one."""
    topic_rate_hz: float = 0.0
    """Maximum recorded rate of a topic, in messages per second."""
    topics: tuple[str, ...] = ()
    versions: dict[str, str] = {}


def present_versions() -> dict[str, str]:
    """Return the package versions that may explain a difference in a replay."""
    return {
        "flexcell": version("flexcell"),
        "python": platform.python_version(),
        "msgspec": version("msgspec"),
        "cel-expr-python": version("cel-expr-python"),
    }


def to_metadata(description: RecordingDescription) -> dict[str, str]:
    """Return the key-value pairs of the metadata record: text unchanged, all other values as JSON."""
    plain: dict[str, object] = msgspec.to_builtins(description)
    pairs = {key: each if isinstance(each, str) else msgspec.json.encode(each).decode() for key, each in plain.items()}
    return {**pairs, _CHECKSUM: _checksum(pairs)}


def from_metadata(pairs: Mapping[str, str], *, where: object) -> RecordingDescription:
    """Read a description back.

    Raises:
        RecordingError: it is not a description, or of a later version.
    """
    if pairs.get(_CHECKSUM) != _checksum(pairs):
        raise RecordingError("its description is damaged", where=where, hint="record it again")
    texts = {field.encode_name for field in msgspec.structs.fields(RecordingDescription) if field.type in (str, _CLOCK)}
    try:
        known = {key: each for key, each in pairs.items() if key != _CHECKSUM}
        plain = {key: each if key in texts else msgspec.json.decode(each) for key, each in known.items()}
        if plain.get("format") != FORMAT:
            raise RecordingError(
                f"this recording has format {plain.get('format')}, not {FORMAT}", where=where, hint="record it again"
            )
        return msgspec.convert(plain, RecordingDescription)
    except (msgspec.DecodeError, RecursionError) as error:
        raise RecordingError(
            f"its description does not fit this version: {error}", where=where, hint="record it again"
        ) from error


def _checksum(pairs: Mapping[str, str]) -> str:
    """Return a checksum of the pairs; MCAP has none for metadata."""
    content = sorted((key, each) for key, each in pairs.items() if key != _CHECKSUM)
    return f"{zlib.crc32(msgspec.json.encode(content)):08x}"


_CLOCK = Literal["virtual", "real"]
