"""A capture: what was noted is in its files, whose number is bounded; a disk that fails ends it and nothing else."""

from __future__ import annotations

import gc
import logging
import threading
from pathlib import Path
from typing import BinaryIO

import pytest

from engine.errors import FlexcellError
from robots.io.wire.capture_file import CaptureFile, CaptureLimits
from robots.io.wire.read_capture import read_capture
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from tests.robots.io.wire.wire_events import TCP4, event


def test_a_capture_has_what_was_noted(tmp_path: Path) -> None:
    capture = WireCapture(tmp_path, device="left/gripper")
    tap = capture.tap("modbus_tcp")
    tap.opened(TCP4)
    tap.sent(b"\x01")
    tap.received(b"\x02\x03")
    tap.ended()
    tap.closed()
    capture.close()
    (file,) = tmp_path.iterdir()
    assert file.name.startswith("left-gripper.modbus_tcp.")
    found = read_capture(file)
    assert (found.device, found.protocol, found.transport, found.dropped) == ("left/gripper", "modbus_tcp", "tcp", 0)
    assert [(each.kind, each.data) for each in found.events] == [
        ("opened", b""),
        ("sent", b"\x01"),
        ("received", b"\x02\x03"),
        ("ended", b""),
        ("closed", b""),
    ]
    times = [each.time_s for each in found.events]
    assert times == sorted(times)


def test_devices_with_similar_names_have_files_of_their_own(tmp_path: Path) -> None:
    """Else each would delete the oldest files of the other."""
    devices = ("left/gripper", "left_gripper", "left-gripper", "left.gripper", "left gripper", "lëft")
    for device in devices:
        capture = WireCapture(tmp_path, device=device)
        capture.tap("modbus_tcp").opened(TCP4)
        capture.close()
    stems = {file.name.removesuffix(".pcapng").rpartition(".")[0] for file in tmp_path.iterdir()}
    assert len(stems) == len(devices)


def test_without_a_folder_nothing_is_captured() -> None:
    tap = NO_CAPTURE.tap("any")
    tap.sent(b"\x01")
    assert not tap.is_active


def test_old_files_of_a_connection_are_deleted_and_those_of_others_are_kept(tmp_path: Path) -> None:
    (tmp_path / "arm.other.1.pcapng").write_bytes(b"")
    limits = CaptureLimits(file_bytes=2_000, files=3)
    file = CaptureFile(tmp_path, device="arm", protocol="lines", limits=limits)
    for number in range(60):
        file.note(event("sent", number.to_bytes(2) * 100))
    file.close()
    kept = sorted(tmp_path.glob("arm.lines.*"))
    assert len(kept) == 3
    assert max(each.stat().st_size for each in kept) < 2_500
    assert read_capture(kept[-1]).events[-1].data == (59).to_bytes(2) * 100
    assert (tmp_path / "arm.other.1.pcapng").exists()


def test_what_the_disk_does_not_take_in_time_is_dropped_and_counted(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    file = CaptureFile(tmp_path, device="arm", protocol="lines", limits=CaptureLimits(waiting=10))
    for _ in range(1000):
        file.note(event("sent", b"x"))
    dropped = file.dropped
    file.close()
    found = read_capture(next(tmp_path.iterdir()))
    assert (len(found.events) + dropped, found.dropped) == (1000, dropped)
    assert dropped > 0
    assert "the disk is too slow for the capture of arm" in caplog.text


def test_a_full_disk_ends_the_capture_with_a_warning(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    new_file = "robots.io.wire.capture_file._CaptureWriter._new_file"
    monkeypatch.setattr(new_file, _full_disk)
    file = CaptureFile(tmp_path, device="arm", protocol="lines")
    with caplog.at_level(logging.WARNING):
        file.note(event("sent", b"x"))
        file.close()
        file.note(event("sent", b"x"))
    assert "the capture of arm (lines) ends: No space left on device" in caplog.text
    assert "the device is not affected" in caplog.text


def test_the_writer_ends_with_its_capture(tmp_path: Path) -> None:
    file = CaptureFile(tmp_path, device="arm", protocol="lines")
    file.note(event("sent", b"x"))
    (writer,) = (each for each in threading.enumerate() if each.name == "capture arm lines")
    del file
    gc.collect()
    assert not writer.is_alive()
    assert len(read_capture(next(tmp_path.iterdir())).events) == 1


def test_what_is_no_capture_is_refused_by_name(tmp_path: Path) -> None:
    file = tmp_path / "other.pcapng"
    with pytest.raises(FlexcellError, match="cannot be read"):
        read_capture(file)
    file.write_bytes(b"GIF89a, and more than twelve bytes")
    with pytest.raises(FlexcellError, match="no capture of this program: offset 0: no section header"):
        read_capture(file)


def _full_disk(_writer: object) -> BinaryIO:
    return Path("/dev/full").open("wb")
