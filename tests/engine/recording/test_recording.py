"""Reading recordings: whatever is in the file, it ends in a recording or in one line that says what is wrong."""

from __future__ import annotations

import struct
import zlib
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from mcap.writer import Writer

from engine.clock import run_virtual
from engine.errors import RecordingError
from engine.recording import Recording, load_recording, part_file
from engine.recording.description import RECORD_NAME
from tests.engine.replay.rig import record_run
from tests.tiers import examples

TEXT = """
root:
  machine:
    initial: work
    states:
      work: {state: bench.Work, with: {for_s: 1}, transitions: {a: look, b: bad, c: bad}}
      look: {state: bench.Look, with: {times: 3}, transitions: {a: good, b: good, c: bad}}
"""
MAGIC = bytes([137, 77, 67, 65, 80, 48, 13, 10])
DAMAGING = settings(
    max_examples=examples(80, nightly=400),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording with topics."""
    path = tmp_path_factory.mktemp("good") / "r.mcap"
    run_virtual(record_run(TEXT, path, rate_hz=50))
    return path


@pytest.fixture(scope="module")
def scratch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A place for files that are no good."""
    return tmp_path_factory.mktemp("bad")


def _read(content: bytes, path: Path) -> Recording | None:
    """Load a file with this content; None where it is refused in one line that says what to do."""
    path.write_bytes(content)
    try:
        return load_recording(path)
    except RecordingError as error:
        refusal = error
    assert "\n" not in str(refusal)
    assert refusal.hint
    return None


@settings(DAMAGING)
@given(content=st.binary(max_size=300))
@example(content=b"")
@example(content=MAGIC)
@example(content=MAGIC + MAGIC)
@example(content=MAGIC + struct.pack("<BQ", 2, 2**63))
@example(content=MAGIC + struct.pack("<BQ", 6, 8) + bytes(8) + MAGIC)
def test_garbage_is_refused(content: bytes, scratch: Path) -> None:
    assert _read(content, scratch / "garbage.mcap") is None
    assert _read(MAGIC + content, scratch / "garbage.mcap") is None
    assert _read(MAGIC + content, scratch / "garbage.mcap.part") is None


@settings(
    max_examples=examples(80, nightly=400), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_a_recording_that_was_cut_off_is_refused(good: Path, scratch: Path, data: st.DataObject) -> None:
    whole = good.read_bytes()
    length = data.draw(st.integers(0, len(whole) - 1))
    assert _read(whole[:length], scratch / "cut.mcap") is None


@settings(
    max_examples=examples(80, nightly=400), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_a_recording_with_damaged_bytes_is_refused_or_read(good: Path, scratch: Path, data: st.DataObject) -> None:
    content = bytearray(good.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    read, whole = _read(bytes(content), scratch / "bits.mcap"), load_recording(good)
    if read is not None:
        assert replace(read, path=good) == whole


def test_a_wrong_bit_anywhere_is_refused_or_makes_no_difference(good: Path, scratch: Path) -> None:
    """Also in what lies between the chunks, which have checksums of their own."""
    content, whole = good.read_bytes(), load_recording(good)
    for at in range(0, len(content), 3):
        damaged = bytearray(content)
        damaged[at] ^= 1 << at % 8
        read = _read(bytes(damaged), scratch / "bit.mcap")
        assert read is None or replace(read, path=good) == whole, at


def test_of_a_live_recording_everything_up_to_the_cut_is_read(tmp_path: Path, scratch: Path) -> None:
    """At every byte: whole events only, in order, never fewer than before."""
    target = tmp_path / "r.mcap"
    part = part_file(target)
    kept: list[bytes] = []
    run_virtual(record_run(TEXT, target, acts={0.9: lambda run: kept.append(part.read_bytes())}))
    live, events = kept[0], load_recording(target).events
    before = -1
    for length in (*range(0, len(live), 97), len(live)):
        (scratch / "live.mcap.part").write_bytes(live[:length])
        try:
            read = load_recording(scratch / "live.mcap.part").events
        except RecordingError:
            assert before == -1
            continue
        assert read == events[: len(read)]
        assert len(read) >= before
        before = len(read)
    assert before == 4  # the start of the run, two nodes, and the goal


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"nowhere\.mcap: cannot read this file: No such file or directory"):
        load_recording(tmp_path / "nowhere.mcap")
    with pytest.raises(RecordingError, match="cannot read this file: Is a directory"):
        load_recording(tmp_path)


def test_a_recording_of_something_else_is_reported_apart(tmp_path: Path) -> None:
    with (tmp_path / "other.mcap").open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        writer.finish()
    with pytest.raises(RecordingError, match="this is not a recording of a run"):
        load_recording(tmp_path / "other.mcap")


def test_a_recording_of_a_later_version_says_so(tmp_path: Path) -> None:
    with (tmp_path / "later.mcap").open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        content = msgspec.json.encode([["format", "2"]])
        writer.add_metadata(RECORD_NAME, {"format": "2", "crc32": f"{zlib.crc32(content):08x}"})
        writer.finish()
    with pytest.raises(RecordingError, match="this recording has format 2, not 1"):
        load_recording(tmp_path / "later.mcap")
