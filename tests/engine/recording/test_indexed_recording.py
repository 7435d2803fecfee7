"""What a topic said at any moment is found in finished recordings and in such that still grow."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.reader import make_reader

from engine.clock import run_virtual
from engine.errors import RecordingError
from engine.recording import part_file, run_recording
from engine.recording.indexed_recording import IndexedRecording
from tests.engine.replay.rig import Tick, record_run

TEXT = """
root:
  machine:
    initial: work
    states:
      work: {state: bench.Work, with: {for_s: 5}, transitions: {a: good, b: bad, c: bad}}
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """One recording twice: finished, and as it was while it grew."""
    path = tmp_path_factory.mktemp("moments") / "r.mcap"
    grown = part_file(path.with_name("grown.mcap"))
    with pytest.MonkeyPatch.context() as patch:
        finish = run_recording.finalize_recording

        def copied(part: Path, target: Path) -> None:
            shutil.copy(part, grown)
            finish(part, target)

        patch.setattr(run_recording, "finalize_recording", copied)
        run_virtual(record_run(TEXT, path, rate_hz=50))
    return path, grown


def ticks(path: Path) -> list[tuple[float, int]]:
    """When the topic said what, as the official reader has it."""
    with path.open("rb") as stream:
        messages = make_reader(stream).iter_messages(topics="/bench/tick")
        return [(message.log_time / 1e9, json.loads(message.data)["number"]) for _, _, message in messages]


@given(time_s=st.floats(-1.0, 7.0))
def test_a_moment_has_the_latest_message_before_it(files: tuple[Path, Path], time_s: float) -> None:
    expected = [number for at_s, number in ticks(files[0]) if at_s <= time_s + 5e-10]
    for path in files:
        with IndexedRecording.open(path) as moments:
            found = moments.at("bench/tick", time_s)
        number = msgspec.json.decode(found.data, type=Tick).number if found is not None else None
        assert number == (expected[-1] if expected else None)


@given(from_s=st.floats(-1.0, 7.0), length_s=st.floats(0.0, 7.0), most=st.integers(1, 400))
def test_a_time_range_has_its_messages_and_the_one_before(
    files: tuple[Path, Path], from_s: float, length_s: float, most: int
) -> None:
    """Of many, some that lie evenly among them."""
    before = [number for at_s, number in ticks(files[0]) if at_s <= from_s + 5e-10]
    inside = [number for at_s, number in ticks(files[0]) if from_s + 5e-10 < at_s <= from_s + length_s + 5e-10]
    expected = [*before[-1:], *inside]
    for path in files:
        with IndexedRecording.open(path) as moments:
            found = list(moments.between("bench/tick", from_s, from_s + length_s, most=most))
        numbers = [msgspec.json.decode(data, type=Tick).number for _, data in found]
        assert numbers == expected[:: max(1, -(-len(expected) // most))]
        assert len(numbers) <= most


def test_topics_and_span_are_reported(files: tuple[Path, Path]) -> None:
    for path in files:
        with IndexedRecording.open(path) as moments:
            assert moments.topics == {"bench/tick": "Tick"}
            assert moments.span_s[0] == 0.0
            assert moments.span_s[1] == pytest.approx(5.0, abs=0.2)
            assert moments.at("no/such", 3.0) is None


def test_the_same_message_has_the_same_place(files: tuple[Path, Path]) -> None:
    for path in files:
        with IndexedRecording.open(path) as moments:
            once, again, later = (moments.at("bench/tick", time_s) for time_s in (2.0, 2.001, 4.0))
        assert once == again != later


def test_what_is_written_meanwhile_is_seen_and_what_is_half_written_is_not(
    files: tuple[Path, Path], tmp_path: Path
) -> None:
    whole = files[1].read_bytes()
    path = tmp_path / "r.mcap.part"
    path.write_bytes(whole[:100])
    with IndexedRecording.open(path) as moments:
        seen: list[float] = []
        for size in (*range(200, len(whole), 997), len(whole)):
            path.write_bytes(whole[:size])
            moments.refresh()
            seen.append(moments.span_s[1])
        last = moments.at("bench/tick", 1e9)
    assert seen == sorted(seen)
    with IndexedRecording.open(files[0]) as finished:
        assert last is not None
        assert last.data == getattr(finished.at("bench/tick", 1e9), "data", None)


@pytest.mark.parametrize("content", [b"", b"no recording", b"\x89MCAP0\r\n" + b"\xff" * 40])
def test_what_is_no_recording_is_refused_in_words(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"x\.mcap"):
        IndexedRecording.open(path)


@given(place=st.integers(0), byte=st.integers(0, 255))
def test_damage_is_reported_in_words_or_changes_nothing(
    files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory, place: int, byte: int
) -> None:
    whole = bytearray(files[0].read_bytes())
    whole[place % len(whole)] = byte
    path = tmp_path_factory.mktemp("damage") / "r.mcap"
    path.write_bytes(whole)
    try:
        with IndexedRecording.open(path) as moments:
            for topic in moments.topics:
                moments.at(topic, 3.0)
    except RecordingError:
        return


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="cannot read"):
        IndexedRecording.open(tmp_path / "none.mcap")
