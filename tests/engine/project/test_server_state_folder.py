"""One server at a time keeps its state in a folder, and says so."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from engine.bus.remote_bus import ServerRecord, server_file
from engine.errors import BusError, FlexcellError
from engine.project.server_state_folder import LOCK_FILE, lock_server_state_folder

URL = "http://127.0.0.1:1/"
HOLD = """
import sys
from pathlib import Path
from engine.project.server_state_folder import lock_server_state_folder
with lock_server_state_folder(Path(sys.argv[1])) as folder:
    folder.announce(url="http://127.0.0.1:1/", token="t")
    print("held", flush=True)
    sys.stdin.read()
"""


def test_a_second_server_is_refused_with_the_first_ones_process_and_address(tmp_path: Path) -> None:
    """What the first has said of itself stays."""
    with lock_server_state_folder(tmp_path / "state") as folder:
        folder.announce(url=URL, token="t")
        with (
            pytest.raises(FlexcellError, match=rf"process {os.getpid()} at {URL}.*--state"),
            lock_server_state_folder(tmp_path / "state"),
        ):
            pass
        assert ServerRecord.read(tmp_path / "state") == ServerRecord(url=URL, token="t", pid=os.getpid())
    with pytest.raises(BusError, match="no server runs here"):
        ServerRecord.read(tmp_path / "state")


def test_a_server_that_starts_is_named_without_an_address(tmp_path: Path) -> None:
    """It has none yet."""
    with (
        lock_server_state_folder(tmp_path),
        pytest.raises(FlexcellError, match=rf"process {os.getpid()}, which is starting"),
        lock_server_state_folder(tmp_path),
    ):
        pass


def test_the_address_and_the_token_are_for_the_owner_only(tmp_path: Path) -> None:
    """Mode 0600, also over a file that was not."""
    server_file(tmp_path).with_suffix(".part").write_text("{}")
    with lock_server_state_folder(tmp_path) as folder:
        folder.announce(url=URL, token="t")
        assert stat.S_IMODE(server_file(tmp_path).stat().st_mode) == 0o600


def test_the_lock_ends_with_the_process_however_it_ends(tmp_path: Path) -> None:
    """After kill -9 the next server starts at once, and no old address is left."""
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(FlexcellError, match=f"process {holder.pid} at"), lock_server_state_folder(tmp_path):
            pass
        holder.kill()
        holder.wait()
        with lock_server_state_folder(tmp_path):
            assert not server_file(tmp_path).exists()


@pytest.mark.parametrize("name", ["file", "file/below"])
def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path, name: str) -> None:
    """With what to do."""
    (tmp_path / "file").write_text("")
    with (
        pytest.raises(FlexcellError, match=r"file.*: the state folder cannot be written: .*--state"),
        lock_server_state_folder(tmp_path / name),
    ):
        pass


def test_a_lock_that_cannot_be_opened_is_reported(tmp_path: Path) -> None:
    """As in a folder of another user."""
    (tmp_path / LOCK_FILE).mkdir()
    with pytest.raises(FlexcellError, match="the state folder cannot be written"), lock_server_state_folder(tmp_path):
        pass
