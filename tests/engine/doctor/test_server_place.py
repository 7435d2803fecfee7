"""What is told of folders and ports: what cannot be written, what is taken, and which server runs."""

from __future__ import annotations

import socket
from pathlib import Path

import msgspec

from engine.bus.remote_bus import ServerRecord, server_file
from engine.doctor.examination import Examination
from engine.doctor.server_place import server_place
from tests.robots.own_address import own_address

HOST = own_address()


def examined(folder: Path, *, port: int, state: str = "state", cache: str = "cache") -> dict[str, Examination]:
    """Return what is told of a place, by subject."""
    found = server_place(folder / state, cache=folder / cache, host=HOST, port=port)
    return {each.subject: each for each in found}


def taken() -> socket.socket:
    """Return a socket that listens."""
    listening = socket.socket()
    listening.bind((HOST, 0))
    listening.listen()
    return listening


def test_folders_that_are_not_there_yet_are_fine_and_are_not_made(tmp_path: Path) -> None:
    with taken() as held:
        port = held.getsockname()[1]
    found = examined(tmp_path, port=port)
    assert [each.condition for each in found.values()] == ["ok"] * 4
    assert found["state folder"].state.endswith("state, made by the first use")
    assert found["server"].state == f"none runs here; port {port} is free"
    assert list(tmp_path.iterdir()) == []


def test_a_state_folder_that_is_a_file_is_a_problem_and_a_cache_that_is_one_a_note(tmp_path: Path) -> None:
    for name in ("state", "cache"):
        (tmp_path / name).write_text("", encoding="utf-8")
    with taken() as held:
        found = examined(tmp_path, port=held.getsockname()[1])
    assert [found[name].condition for name in ("state folder", "cache folder")] == ["problem", "note"]
    assert "state cannot be written: is no folder" in found["state folder"].state
    assert "flexcell serve --state FOLDER" in found["state folder"].advice


def test_a_port_that_another_program_has_is_a_note_with_what_to_do(tmp_path: Path) -> None:
    with taken() as held:
        port = held.getsockname()[1]
        found = examined(tmp_path, port=port)["server"]
    assert (found.condition, str(port) in found.state) == ("note", True)
    assert "--port" in found.advice


def test_a_server_that_answers_is_named_and_the_record_of_one_that_was_killed_is_not(tmp_path: Path) -> None:
    (tmp_path / "state").mkdir()
    with taken() as held:
        port = held.getsockname()[1]
        url = f"http://{HOST}:{port}/"
        record = ServerRecord(url=url, token="a token", pid=1)
        server_file(tmp_path / "state").write_bytes(msgspec.json.encode(record))
        assert examined(tmp_path, port=port)["server"].state == f"runs at {url}"
    assert examined(tmp_path, port=port)["server"].state == f"none runs here; port {port} is free"
