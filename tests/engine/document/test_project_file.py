"""Project files: found in the folder of a document or above it, and strict."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.project_file import find_project, load_project
from engine.errors import DocumentError


def written(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "flexcell.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_the_nearest_file_counts(tmp_path: Path) -> None:
    outer = written(tmp_path, "flexcell: 1\nstates: [outer]\n")
    inner = written(tmp_path / "inner", "flexcell: 1\nstates: [inner.states, b]\n")
    (tmp_path / "inner" / "behaviors").mkdir()
    found = find_project(tmp_path / "inner" / "behaviors" / "x.yaml")
    assert found is not None
    assert (found.file, found.folder, found.document.states) == (inner, inner.parent, ("inner.states", "b"))
    above = find_project(tmp_path / "other")
    assert above is not None
    assert above.file == outer


def test_a_folder_that_everybody_may_write_to_is_nobodys_project(tmp_path: Path) -> None:
    """As `/tmp` is."""
    written(tmp_path / "open", "flexcell: 1\nstates: [os]\n")
    (tmp_path / "open").chmod(0o1777)
    assert find_project(tmp_path / "open") is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("flexcell: 1\nstate: [a]\n", r"flexcell\.yaml:2:1: unknown key `state` \(did you mean states"),
        ("flexcell: 1\nstates: ['a:B']\n", r"flexcell\.yaml:2:10: .*allowed form.*without a class"),
        ("flexcell: 1\nstates: ['../a']\n", "allowed form"),
        ("flexcell: 2\n", "flexcell"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(DocumentError, match=message):
        load_project(written(tmp_path, text))
