"""The store commands, alike on a file and on a MongoDB server."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

from engine.cli.commands.store import app
from engine.errors import FlexcellError
from tests.engine.cli.command import FLEXCELL, flexcell
from tests.engine.store.mongod import RUNS_HERE, Mongod

DATABASE = "commands"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mongod]:
    """A replica set of one server."""
    if not RUNS_HERE:
        pytest.skip("the MongoDB server of the tests runs on Linux x86-64 only")
    mongod = Mongod(replicated=True, folder=tmp_path_factory.mktemp("mongod"))
    mongod.start()
    yield mongod
    mongod.remove()


def output(*arguments: str) -> str:
    """What `flexcell store` prints, in this process; times are WHEN, errors as the command line tells them."""
    result = CliRunner().invoke(app, list(arguments))
    assert result.exception is None or isinstance(result.exception, FlexcellError), result.exception
    told = f"error: {result.exception}" if result.exception is not None else result.stdout
    return re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\dZ", "WHEN", told)


def test_a_life_of_an_entry_reads_the_same_on_both_stores(server: Mongod, tmp_path: Path) -> None:
    """Set, refused, overwritten, shown, listed, undone, deleted, its history, migrated."""
    told: list[list[str]] = []
    file, address = str(tmp_path / "s.db"), f"{server.uri}/{DATABASE}"
    for at in (("--store", file), ("--store", address)):
        who = ("--by", "ana")
        told.append(
            [
                output("set", "joints", "home", '{"joints": [1, 2]}', "--tag", "fast", "--reason", "taught", *who, *at),
                output("set", "joints", "home", '{"joints": [3]}', "--expected-revision", "7", *who, *at),
                output("set", "joints", "home", '{"joints": [1, 3]}', *who, *at),
                output("undo", "joints", "home", "--reason", "worse", *who, *at),
                output("show", "joints", "home", *at),
                output("list", "--search", "ho", "--tag", "fast", *at),
                output("export", *at),
                output("delete", "joints", "home", *who, *at),
                output("history", "joints", "home", *at),
                output("get", "joints", "home", *at),
                output("list", "--json", *at),
            ]
        )
    assert told[0] == told[1]
    assert told[0][1] == (
        "error: joints home: revision 1 is stored, revision 7 was expected (read the entry again and retry)"
    )
    assert told[0][3] == "joints home revision 3 undone to revision 1 WHEN by ana: worse\n"
    assert told[0][4].splitlines()[1:] == ["tags: fast", "joints: [1.0, 2.0]", 'model: ""', "names: []"]
    history = [
        "revision 1 written WHEN by ana: taught",
        "revision 2 written WHEN by ana",
        "revision 3 undone to revision 1 WHEN by ana: worse",
        "revision 4 deleted WHEN by ana",
    ]
    assert told[0][8].splitlines() == history
    assert told[0][9:] == ["error: store: there is no joints entry called home (there are none)", "[]\n"]
    moved = str(tmp_path / "moved.db")
    assert output("migrate", address, moved).startswith(f"1 entries with 4 changes are in {moved}, 4 new; verified")
    assert output("history", "joints", "home", "--store", moved).splitlines() == history


def test_migrating_from_a_file_that_is_not_there_makes_none(tmp_path: Path) -> None:
    """A mistyped name is told."""
    done = flexcell("store", "migrate", "typo.db", "new.db", cwd=tmp_path)
    assert (done.code, done.err) == (2, "flexcell: typo.db: there is no such store file\n")
    assert list(tmp_path.iterdir()) == []


def test_data_of_mongodb_store_is_imported_and_what_changed_is_said(tmp_path: Path) -> None:
    """A name that none may have here, and a message of another type."""
    state: dict[str, object] = {"header": {}, "name": [], "position": [1.0, 2.0], "velocity": [], "effort": []}
    documents = [
        {**state, "_meta": {"name": "Home 1", "stored_type": "sensor_msgs/JointState"}},
        {"data": True, "_meta": {"name": "flag", "stored_type": "std_msgs/Bool"}},
    ]
    (tmp_path / "dump.json").write_text("\n".join(map(json.dumps, documents)))
    done = flexcell("store", "import", "dump.json", "--format", "mongodb_store", "--store", "s.db", cwd=tmp_path)
    assert (done.code, done.out) == (0, "2 of 2 entries written\n")
    assert done.err == "flexcell: 'Home 1' is imported as home_1\n"
    exported = flexcell("store", "export", "--format", "mongodb_store", "--store", "s.db", cwd=tmp_path)
    assert [json.loads(line)["_meta"]["stored_type"] for line in exported.out.splitlines()] == [
        "sensor_msgs/JointState",
        "std_msgs/String",
    ]


@pytest.mark.parametrize("on_server", [False, True], ids=["file", "server"])
def test_watching_prints_what_another_program_writes(on_server: bool, server: Mongod, tmp_path: Path) -> None:
    """As it happens."""
    store = f"{server.uri}/watched" if on_server else "s.db"
    command = [str(FLEXCELL), "store", "watch", "--count", "1", "--store", store]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as watching:
        assert watching.stderr is not None
        assert watching.stdout is not None
        assert watching.stderr.readline().startswith("flexcell: watching ")
        flexcell("store", "set", "record", "a", "{}", "--by", "ana", "--store", store, cwd=tmp_path)
        assert watching.stdout.readline().startswith("record a revision 1 written ")
        assert watching.wait(30) == 0


def test_a_server_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    """No traceback, exit code 2."""
    address = "mongodb://127.0.0.1:1/?serverSelectionTimeoutMS=100"
    done = flexcell("store", "list", "--store", address, cwd=tmp_path)
    assert done.code == 2
    assert done.err.count("\n") == 1
    assert done.err.startswith(
        "flexcell: mongodb://127.0.0.1:1/flexcell: the store cannot be opened: the server cannot"
    )


def test_tags_go_through_a_document_from_one_store_to_another(tmp_path: Path) -> None:
    """Exported and imported again; what the document says no tags of keeps its own."""
    here, there, file = str(tmp_path / "here.db"), str(tmp_path / "there.db"), tmp_path / "entries.yaml"
    output(
        "set", "joints", "home", '{"joints": [1], "names": ["a"]}', "--tag", "tested", "--tag", "fast", "--store", here
    )
    output("set", "record", "tray", '{"rows": 4}', "--store", here)
    output("set", "record", "tray", '{"rows": 3}', "--tag", "old", "--store", there)
    file.write_text(output("export", "--store", here), encoding="utf-8")
    assert output("import", str(file), "--overwrite", "--store", there) == "2 of 2 entries written\n"
    listed = json.loads(output("list", "--json", "--store", there))
    assert [(key["name"], key["tags"]) for key in listed] == [("home", ["fast", "tested"]), ("tray", ["old"])]
    assert output("export", "--store", there).replace("  records:\n    tray: [old]\n", "") == file.read_text(
        encoding="utf-8"
    )
