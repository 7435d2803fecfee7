"""The growing file: whole after a kill, and a full disk is a warning."""

from __future__ import annotations

import errno
import logging
import os
import signal
import subprocess
import sys
import threading
from io import BytesIO
from pathlib import Path

import pytest

from engine.errors import RecordingError
from engine.recording import live_file
from engine.recording.file_content import read_content
from engine.recording.live_file import LiveFile

KILLED = """
import sys
from pathlib import Path
from engine.recording.live_file import LiveFile

live = LiveFile.open(Path(sys.argv[1]), inline=True)
channel = live.channel("/t", "t", b"{}", metadata={})
for number in range(500):
    live.write(channel, number, b'{"n":%d}' % number)
print("written", flush=True)
sys.stdin.read()
"""


def _numbers(path: Path) -> list[bytes]:
    return [message.data for message in read_content(path, "/t").messages]


@pytest.mark.parametrize("inline", [True, False])
def test_what_is_written_is_there_in_order(tmp_path: Path, inline: bool) -> None:
    live = LiveFile.open(tmp_path / "r", inline=inline)
    live.describe("d", {"k": "v"})
    live.attach("a.yaml", b"text", media_type="application/yaml")
    channel = live.channel("/t", "t", b"{}", metadata={})
    for number in range(1000):
        live.write(channel, number, b"%d" % number)
    live.close()
    live.close()
    content = read_content(tmp_path / "r", "/t")
    assert [message.data for message in content.messages] == [b"%d" % number for number in range(1000)]
    assert (content.metadata, content.attachments) == ({"d": {"k": "v"}}, {"a.yaml": b"text"})
    assert not content.complete


def test_a_kill_loses_nothing_that_was_written(tmp_path: Path) -> None:
    file = tmp_path / "r.part"
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, file], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=Path.cwd()
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"written\n"
        process.send_signal(signal.SIGKILL)
    assert _numbers(file) == [b'{"n":%d}' % number for number in range(500)]


@pytest.mark.parametrize("inline", [True, False])
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_a_full_disk_ends_the_recording_with_one_warning(caplog: pytest.LogCaptureFixture, inline: bool) -> None:
    with caplog.at_level(logging.WARNING, logger="flexcell.recording"):
        live = LiveFile.open(Path("/dev/full"), inline=inline)
        channel = live.channel("/t", "t", b"{}", metadata={})
        for number in range(100):
            live.write(channel, number, b"0")
        live.close()
    assert live.failure == os.strerror(errno.ENOSPC)
    assert [record.getMessage() for record in caplog.records] == [
        "the recording ends here, the run continues: /dev/full: No space left on device"
    ]


def test_a_file_that_cannot_be_created_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="cannot be created: No such file or directory"):
        LiveFile.open(tmp_path / "nowhere" / "r", inline=True)


def test_two_do_not_record_into_one_file(tmp_path: Path) -> None:
    live = LiveFile.open(tmp_path / "r", inline=True)
    with pytest.raises(RecordingError, match="another process is recording into this file"):
        LiveFile.open(tmp_path / "r", inline=True)
    live.close()
    LiveFile.open(tmp_path / "r", inline=True).close()


class StalledDisk(BytesIO):
    """A disk that takes nothing until it is told to."""

    def __init__(self) -> None:
        super().__init__()
        self.go_on = threading.Event()

    def flush(self) -> None:
        if not self.closed:
            self.go_on.wait()
            super().flush()


def test_while_the_disk_stalls_topics_are_left_out_first_and_events_end_the_recording(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live_file, "MAX_TOPIC_BACKLOG", 10_000)
    monkeypatch.setattr(live_file, "MAX_BACKLOG", 20_000)
    disk = StalledDisk()
    live = LiveFile(tmp_path / "r", disk, inline=False)
    channel = live.channel("/t", "t", b"{}", metadata={})
    for number in range(100):
        live.write_if_quick(channel, number, b"0" * 1000)
    assert live.left_out > 80
    assert live.failure is None
    for number in range(100):
        live.write(channel, number, b"0" * 1000)
    assert live.failure == "the disk is too slow"
    disk.go_on.set()
    live.close()
