"""What differs although every event comes again: an altered result that nobody reads, and another default."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.recording import Recording, load_recording, run_recording
from engine.replay import ReplayReport, replay
from tests.engine.recording.altered_recording import alter_events
from tests.engine.replay.rig import CATALOGUE, behavior_of, recorded

TEXT = """
flexcell: 1
name: work
parameters:
  for_s: {type: number, default: 1}
  unread: {type: number, default: 0.5}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: work
    states:
      work: {state: bench.Work, with: {for_s: "${for_s}"}, transitions: {a: good, b: bad, c: bad}}
"""
UNREAD = b'"stopped":false'


def altered(tmp_path: Path, old: bytes, new: bytes | None) -> Recording:
    """Record a run and replace a text in its events; None drops the events with it."""
    recorded(TEXT, tmp_path / "r.mcap")
    hits: list[bytes] = []

    def alter(data: bytes) -> bytes | None:
        if old not in data:
            return data
        hits.append(data)
        return None if new is None else data.replace(old, new)

    altered_file = alter_events(tmp_path / "r.mcap", tmp_path / "altered.mcap", alter)
    assert hits
    return load_recording(altered_file)


def lines(report: ReplayReport) -> list[str]:
    return [str(each) for each in report.differences]


def test_a_result_that_nobody_reads_and_that_was_altered_is_named(tmp_path: Path) -> None:
    """Every event comes again; the digests of the recording tell."""
    recording = altered(tmp_path, UNREAD, b'"stopped":true')
    report = replay(recording, CATALOGUE)
    (line,) = lines(report)
    assert report.compared == len(recording.events)
    assert not report.same
    assert line.startswith("event 5 at 1.000 s, root/work: recorded an event with digest ")
    assert "; replayed `goal root/work#1.1 succeeded`, {" in line
    assert '"stopped":true' in line
    assert line.endswith("(the recording was altered after the run)")


def test_a_recording_as_it_was_written_is_verified_also_where_it_was_copied(tmp_path: Path) -> None:
    recording = altered(tmp_path, UNREAD, UNREAD)
    assert recording.altered == {}
    assert replay(recording, CATALOGUE).same


def test_an_altered_result_that_is_read_differs_twice(tmp_path: Path) -> None:
    """As the event that comes of it, and as the record itself."""
    report = replay(altered(tmp_path, b'"worked_s":1.0', b'"worked_s":2.0'), CATALOGUE)
    assert [each.number for each in report.differences] == [6, 5]
    assert report.difference is report.differences[0]
    assert "was altered" not in str(report.difference)


@pytest.mark.parametrize(
    ("dropped", "texts"),
    [
        (b'"event":"run_ended"', ["nothing (the recording was altered after the run: events are missing)"]),
        (b'"event":"userdata"', ["(the recording was altered after the run)"]),
    ],
)
def test_events_that_were_taken_out_are_missed(tmp_path: Path, dropped: bytes, texts: list[str]) -> None:
    found = lines(replay(altered(tmp_path, dropped, None), CATALOGUE))
    assert found
    for text in texts:
        assert any(line.endswith(text) for line in found), found


def changed(tmp_path: Path, old: str, new: str, *, given: dict[str, object] | None = None) -> ReplayReport:
    """Record a run, and replay it with a part of its text changed."""
    assert old in TEXT
    recording = recorded(TEXT, tmp_path / "r.mcap", parameters=given)
    return replay(recording, CATALOGUE, behavior=behavior_of(TEXT.replace(old, new)))


def test_a_changed_default_of_a_parameter_differs_with_both_values(tmp_path: Path) -> None:
    """The replay sets the recorded value: no event tells."""
    report = changed(tmp_path, "for_s: {type: number, default: 1}", "for_s: {type: number, default: 2}")
    assert not report.same
    assert report.compared == len(report.recording.events)
    assert lines(report) == [
        "event 1 at 0.000 s: recorded parameter `for_s = 1`, by default; replayed default `for_s = 2` "
        "(a run would differ; to keep the value, set it: -p for_s=1)"
    ]


def test_each_changed_default_is_named_also_of_one_that_nothing_reads(tmp_path: Path) -> None:
    report = changed(
        tmp_path,
        "for_s: {type: number, default: 1}\n  unread: {type: number, default: 0.5}",
        "for_s: {type: number}\n  unread: {type: number, default: 0.75}",
    )
    required, other = lines(report)
    assert "replayed no default for `for_s`" in required
    assert "recorded parameter `unread = 0.5`, by default; replayed default `unread = 0.75`" in other


def test_a_changed_default_is_no_difference_for_a_run_that_was_given_the_value(tmp_path: Path) -> None:
    assert changed(tmp_path, "default: 1}", "default: 2}", given={"for_s": 3}).same


def test_another_label_of_a_parameter_is_no_difference(tmp_path: Path) -> None:
    assert changed(tmp_path, "default: 1}", "default: 1, label: Time}").same


def test_a_recording_without_digests_is_unverified(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a killed process, or of an earlier version."""
    recorded(TEXT, tmp_path / "r.mcap")
    assert load_recording(tmp_path / "r.mcap").altered == {}
    monkeypatch.setattr(run_recording, "DIGESTS_NAME", "unknown")
    recorded(TEXT, tmp_path / "old.mcap")
    assert load_recording(tmp_path / "old.mcap").altered is None
