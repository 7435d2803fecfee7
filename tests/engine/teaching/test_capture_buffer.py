"""The buffer keeps captures on disk, survives what it cannot read, and says when it is full."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import StoreError
from engine.skills.teaching import Capture, CaptureSummary
from engine.teaching.capture_buffer import MAX_CAPTURES, CaptureBuffer


def capture(number: int) -> Capture:
    summary = CaptureSummary(id=number, taken_at_s=1.0, trigger="key", robot="left", form="joints")
    return Capture(summary=summary, joints=(0.5, -0.5))


def test_captures_are_there_again_after_a_restart(tmp_path: Path) -> None:
    first = CaptureBuffer(tmp_path)
    first.put(capture(1))
    first.put(capture(2))
    first.discard(1)
    again = CaptureBuffer(tmp_path)
    assert again.captures == (capture(2),)
    assert again.next_id() == 3


def test_a_file_that_is_no_capture_is_left_alone(tmp_path: Path) -> None:
    CaptureBuffer(tmp_path).put(capture(4))
    broken = tmp_path / "capture-000002.json"
    broken.write_bytes(b"\x00\xff not json")
    assert CaptureBuffer(tmp_path).captures == (capture(4),)
    assert broken.exists()


def test_a_disk_that_takes_nothing_is_reported_and_the_capture_kept(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way", encoding="utf-8")
    buffer = CaptureBuffer(blocked / "captures")
    with pytest.raises(StoreError, match="cannot be written to disk"):
        buffer.put(capture(1))
    assert buffer.get(1) == capture(1)


def test_a_full_buffer_takes_no_more() -> None:
    buffer = CaptureBuffer(None)
    for number in range(1, MAX_CAPTURES + 1):
        buffer.put(capture(number))
    with pytest.raises(StoreError, match="are not saved"):
        buffer.next_id()


def test_a_capture_that_is_not_there_is_named() -> None:
    with pytest.raises(StoreError, match="there is no capture 7"):
        CaptureBuffer(None).get(7)
