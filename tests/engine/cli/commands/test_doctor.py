"""`flexcell doctor` in a folder: its lines, its JSON, its exit code."""

from __future__ import annotations

from pathlib import Path

import msgspec

from engine.doctor.examination import Examination
from tests.engine.cli.command import flexcell


def test_it_prints_each_subject_with_what_to_do_and_changes_nothing(tmp_path: Path) -> None:
    done = flexcell("doctor", cwd=tmp_path)
    assert (done.code, list(tmp_path.iterdir())) == (0, [])
    lines = done.out.splitlines()
    assert {"Installation", "Place", "Machine"} <= set(lines)
    assert any(line.split()[:3] == ["ok", "extra", "sim"] for line in lines)
    assert lines[-1].startswith("No problems, ")


def test_what_every_user_needs_and_does_not_work_is_exit_code_1(tmp_path: Path) -> None:
    (tmp_path / ".flexcell").write_text("", encoding="utf-8")
    done = flexcell("doctor", "--json", cwd=tmp_path)
    found = msgspec.json.decode(done.out, type=list[Examination])
    assert done.code == 1
    assert [each.subject for each in found if each.condition == "problem"] == ["state folder"]
