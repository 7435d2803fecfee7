"""A recorded run, read with the official MCAP reader as Foxglove would."""

from __future__ import annotations

import asyncio
import json
import logging
import subprocess
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from mcap.reader import make_reader
from mcap.records import Channel, Message, Schema

from engine.bus import SkillBus
from engine.clock import run_virtual
from engine.errors import RecordingError
from engine.event import MessageLogged, NodeEntered, RunStarted
from engine.journal import encode_event_log
from engine.messages import FramePoses, JointState
from engine.recording import load_recording, part_file, recovered_file
from engine.recording.recording import RecordedEvent
from engine.runtime.run import Run
from tests.engine.awaited import wait_until
from tests.engine.recording.foxglove_rules import complaints
from tests.engine.replay.rig import Tick, record_run, recorded
from tests.engine.run_document import run_document

PROJECT = Path(__file__).parents[3]
TEXT = """
root:
  machine:
    initial: work
    states:
      work: {state: bench.Work, with: {for_s: 2}, transitions: {a: look, b: bad, c: bad}}
      look: {state: bench.Look, transitions: {a: good, b: good, c: bad}}
"""
Read = tuple[Schema, Channel, Message]


def read(path: Path) -> list[Read]:
    """Every message with its channel and schema, as the official reader gives them."""
    with path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert reader.get_summary() is not None
        return [(schema, channel, message) for schema, channel, message in reader.iter_messages() if schema is not None]


def of(messages: list[Read], topic: str) -> list[tuple[float, Any]]:
    """The messages of one topic with their times in seconds."""
    return [(m.log_time / 1e9, json.loads(m.data)) for _, channel, m in messages if channel.topic == topic]


def test_every_event_is_there_as_the_journal_has_it(tmp_path: Path) -> None:
    result, events = run_virtual(record_run(TEXT, tmp_path / "r.mcap"))
    assert result.outcome == "good"
    lines = [m.data for _, channel, m in read(tmp_path / "r.mcap") if channel.topic == "/flexcell/events"]
    assert b"".join(line + b"\n" for line in lines) == encode_event_log(events)
    assert [each.event for each in load_recording(tmp_path / "r.mcap").events] == list(events)
    assert not part_file(tmp_path / "r.mcap").exists()


def test_channels_and_messages_are_what_foxglove_reads(tmp_path: Path) -> None:
    run_virtual(record_run(TEXT, tmp_path / "r.mcap", rate_hz=50))
    messages = read(tmp_path / "r.mcap")
    assert {channel.topic for _, channel, _ in messages} == {"/flexcell/events", "/foxglove/log", "/bench/tick"}
    for schema, channel, message in messages:
        assert (channel.message_encoding, schema.encoding) == ("json", "jsonschema")
        assert list(complaints(json.loads(schema.data))) == []
        jsonschema.validate(json.loads(message.data), json.loads(schema.data))
    assert ("foxglove.Log", "/foxglove/log") in {(schema.name, channel.topic) for schema, channel, _ in messages}


def test_the_run_is_described_and_its_documents_go_along(tmp_path: Path) -> None:
    head = "flexcell: 1\nname: given\noutcomes: [good, bad]\n"
    given = "parameters: {p: {type: number, default: 1}}\nuserdata: {u: 0}\n"
    recording = recorded(head + given + TEXT, tmp_path / "r.mcap", parameters={"p": 2}, inputs={"u": [1, "x"]}, seed=7)
    description = recording.description
    assert (description.run, description.behavior, description.clock, description.seed) == ("r", "given", "virtual", 7)
    assert (description.parameters, description.inputs) == ({"p": 2.0}, {"u": [1, "x"]})
    assert description.versions["flexcell"]
    with (tmp_path / "r.mcap").open("rb") as stream:
        attachments = list(make_reader(stream).iter_attachments())
    assert [(each.name, each.media_type) for each in attachments] == [("test.yaml", "application/yaml")]
    assert recording.documents.texts == {"test.yaml": attachments[0].data}


@pytest.mark.parametrize(
    ("rate_hz", "numbers"),
    [(50.0, [0, 1, 2, 3, 4, 5, 6, 7]), (2.0, [0, 2, 4, 6, 7]), (1.0, [0, 4, 7])],
    ids=["all", "every second", "every fourth"],
)
def test_a_topic_is_thinned_out_to_the_rate_and_its_last_message_kept(
    tmp_path: Path, rate_hz: float, numbers: list[int]
) -> None:
    """It ticks every quarter of a second for two seconds."""
    run_virtual(record_run(TEXT, tmp_path / "r.mcap", rate_hz=rate_hz))
    ticks = of(read(tmp_path / "r.mcap"), "/bench/tick")
    assert [tick["number"] for _, tick in ticks] == numbers
    assert all(later - earlier >= 1 / rate_hz for (earlier, _), (later, _) in pairwise(ticks[:-1]))


def test_only_topics_of_these_names_are_recorded(tmp_path: Path) -> None:
    run_virtual(record_run(TEXT, tmp_path / "r.mcap", rate_hz=50, topics=("bench/joint*",)))
    assert of(read(tmp_path / "r.mcap"), "/bench/tick") == []


def _record(path: Path, publish: Callable[[SkillBus], None]) -> list[Read]:
    """Record a run in which something is published after half a second."""

    def prepare(bus: SkillBus) -> None:
        asyncio.get_running_loop().call_later(0.5, publish, bus)

    run_virtual(record_run(TEXT, path, rate_hz=50, prepare=prepare))
    return read(path)


def test_a_topic_that_is_made_later_is_recorded_too(tmp_path: Path) -> None:
    messages = _record(tmp_path / "r.mcap", lambda bus: bus.topic("late", Tick).publish(Tick(number=1)))
    assert of(messages, "/late") == [(0.5, {"number": 1})]


def test_frames_and_joints_also_come_as_foxglove_knows_them(tmp_path: Path) -> None:
    def publish(bus: SkillBus) -> None:
        poses = FramePoses(time_s=0.5, names=("a",), xyz=((1.0, 2.0, 3.0),), xyzw=((0.0, 0.0, 0.0, 1.0),))
        bus.topic("cell/frames", FramePoses).publish(poses)
        joints = JointState(time_s=0.5, names=("j",), position_rad=(1.0,), velocity_rad_s=(2.0,), effort_nm=(3.0,))
        bus.topic("left/joint_state", JointState).publish(joints)

    messages = _record(tmp_path / "r.mcap", publish)
    names = {channel.topic: schema.name for schema, channel, _ in messages}
    assert names["/foxglove/tf/cell/frames"] == "foxglove.FrameTransforms"
    assert names["/foxglove/joints/left/joint_state"] == "foxglove.JointStates"
    stamp = {"sec": 0, "nsec": 500_000_000}
    assert of(messages, "/foxglove/tf/cell/frames") == [
        (
            0.5,
            {
                "transforms": [
                    {
                        "timestamp": stamp,
                        "parent_frame_id": "world",
                        "child_frame_id": "a",
                        "translation": {"x": 1.0, "y": 2.0, "z": 3.0},
                        "rotation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
                    }
                ]
            },
        )
    ]
    joint = {"name": "j", "position": 1.0, "velocity": 2.0, "effort": 3.0}
    assert of(messages, "/foxglove/joints/left/joint_state") == [(0.5, {"timestamp": stamp, "joints": [joint]})]


def test_a_message_that_cannot_be_shown_hurts_neither_publisher_nor_run(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    crooked = FramePoses(time_s=0.5, names=("a", "b"), xyz=(), xyzw=())
    topics: list[object] = []

    def publish(bus: SkillBus) -> None:
        bus.topic("cell/frames", FramePoses).publish(crooked)
        topics.append(bus.topic("cell/frames", FramePoses).latest)

    with caplog.at_level(logging.CRITICAL):
        messages = _record(tmp_path / "r.mcap", publish)
    assert topics == [crooked]
    assert of(messages, "/flexcell/events")[-1][1]["status"] == "finished"


def test_recording_changes_nothing_in_the_run(tmp_path: Path) -> None:
    text = """
    root:
      concurrency:
        states: {left: {state: test.Give, with: {after_s: 1}}, right: {state: test.Give, with: {after_s: 1}}}
        conditions: [{good: {left: a, right: a}}]
    """
    _, events = run_virtual(record_run(text, tmp_path / "r.mcap", rate_hz=50))
    assert encode_event_log(events) == encode_event_log(run_document(text).events)


KILLED = """
import asyncio, sys
from pathlib import Path
from tests.engine.replay.rig import record_run

WAIT = "root: {machine: {initial: w, states: {w: {state: test.Give, with: {after_s: 100}, transitions: {a: good}}}}}"
asyncio.run(record_run(WAIT, Path(sys.argv[1]), acts={0.2: lambda run: print("going on", flush=True)}))
"""


def events_left(target: Path) -> tuple[RecordedEvent, ...]:
    """Return what there is of a recording under way; nothing while its head is being written."""
    try:
        return load_recording(target).events
    except RecordingError:
        return ()


def test_what_a_killed_process_left_is_read_and_kept_beside_the_next_recording(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    target = tmp_path / "r.mcap"
    with subprocess.Popen([sys.executable, "-c", KILLED, target], stdout=subprocess.PIPE, cwd=PROJECT) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"going on\n"
        # Its events go to the disk by a thread of its own.
        wait_until(lambda: len(events_left(target)) >= 3)
        process.kill()
    left = load_recording(target)
    assert (left.path, left.complete) == (part_file(target), False)
    assert [type(each.event) for each in left.events] == [RunStarted, NodeEntered, NodeEntered]
    with caplog.at_level(logging.WARNING, logger="flexcell.recording"):
        run_virtual(record_run(TEXT, target))
    assert f"an earlier recording is truncated; its complete records are in {recovered_file(target)}" in caplog.text
    assert load_recording(recovered_file(target)).events == left.events
    assert load_recording(target).complete


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_a_full_disk_is_a_warning_and_the_run_goes_on(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    target = tmp_path / "r.mcap"
    part_file(target).symlink_to("/dev/full")
    with caplog.at_level(logging.WARNING, logger="flexcell.recording"):
        result, _ = run_virtual(record_run(TEXT, target, rate_hz=50))
    assert result.outcome == "good"
    assert "the recording ends here, the run continues" in caplog.text
    assert not target.exists()


def test_userdata_that_is_no_json_ends_the_recording_and_not_the_run(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    def spoil(run: Run) -> None:
        broken: Any = object()
        run.recorder.emit(MessageLogged, path="", level="info", message=broken)

    with caplog.at_level(logging.WARNING, logger="flexcell.recording"):
        result, _ = run_virtual(record_run(TEXT, tmp_path / "r.mcap", acts={1.0: spoil}))
    assert result.outcome == "good"
    assert "cannot be written as JSON" in caplog.text
