"""`flexcell runs` tells which runs are damaged, and which nobody can tell of."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path

import pytest
from typer.testing import CliRunner

from engine.cli.commands.runs import app
from engine.errors import JournalError
from engine.event import MessageLogged
from engine.journal import Journal, RunOrigin
from tests.engine.journal.older_journal import write_older_journal


def changed(folder: Path, statement: str) -> None:
    connection = sqlite3.connect(folder / "journal.db", isolation_level=None)
    connection.execute(statement)
    connection.close()


async def test_a_damaged_run_is_listed_and_its_events_are_not_shown(tmp_path: Path) -> None:
    with Journal.open(tmp_path, inline=True) as journal:
        for name in ("first", "second"):
            origin = RunOrigin(behavior="/b.yaml")
            run = journal.begin(name, behavior="b", document="d", started_unix_s=0.0, origin=origin)
            for seq in (1, 2, 3):
                run.append(MessageLogged(seq=seq, time_s=0.0, path="root", level="info", message=f"step {seq}"))
            await run.commit()
    changed(tmp_path, "UPDATE run SET behavior = 'other' WHERE id = 'first'")
    damaged = "CAST(replace(CAST(data AS TEXT), 'step 2', 'step 9') AS BLOB)"
    changed(tmp_path, f"UPDATE block SET data = {damaged} WHERE run = 'second'")
    said = CliRunner().invoke(app, ["--journal", str(tmp_path)])
    assert said.exit_code == 0
    assert [line.split()[2] for line in said.stdout.splitlines()] == ["status", "damaged", "interrupted"]
    assert said.stderr == "flexcell: first: the record of run first is damaged\n"
    for name, place in (("first", "the record of run first"), ("second", "event 2 of run second")):
        shown = CliRunner().invoke(app, ["show", name, "--events", "--journal", str(tmp_path)])
        assert shown.stdout == ""
        with pytest.raises(JournalError, match=rf"journal\.db: .*{place} is damaged"):
            raise shown.exception or AssertionError(shown.stdout)


def test_a_run_of_an_older_version_is_said_to_be_unverified(tmp_path: Path) -> None:
    event = MessageLogged(seq=1, time_s=0.0, path="root", level="info", message="x")
    write_older_journal(tmp_path / "journal.db", 3, "old", [event])
    said = CliRunner().invoke(app, ["--journal", str(tmp_path)])
    assert said.stderr == "flexcell: unverified, written by an older version: old\n"
    listed = json.loads(CliRunner().invoke(app, ["--json", "--journal", str(tmp_path)]).stdout)
    assert [(line["id"], line["verified"], line["damage"]) for line in listed] == [("old", False, "")]
    shown = CliRunner().invoke(app, ["show", "old", "--journal", str(tmp_path)])
    assert "unverified: an older version, which wrote no checksums, wrote part of this run" in shown.stdout
