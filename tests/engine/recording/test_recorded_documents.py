"""The documents of a recording: all that a run is made of, by paths below one folder, and nowhere else."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from engine.document import load_behavior
from engine.document.cell import load_cell
from engine.errors import RecordingError
from engine.recording import RecordedDocuments, collect_documents
from tests.engine.replay.rig import behavior_of

OUTER = """flexcell: 1
name: outer
outcomes: [good]
root:
  machine:
    initial: inner
    states: {inner: {behavior: ../lib/inner.yaml, transitions: {good: good}}}
"""
INNER = "flexcell: 1\nname: inner\noutcomes: [good]\nroot: {state: test.Give}\n"
CELL = "flexcell: 1\ncell: c\nstore: {kind: sqlite, path: x.db, seed: entries.yaml}\n"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A behavior, one it refers to, a cell and its entries, in three folders."""
    for name, text in (
        ("p/work/outer.yaml", OUTER),
        ("p/lib/inner.yaml", INNER),
        ("p/cells/cell.yaml", CELL),
        ("p/cells/entries.yaml", "flexcell: 1\n"),
    ):
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return tmp_path / "p"


def test_everything_goes_along_and_nothing_of_where_it_was(project: Path) -> None:
    behavior = load_behavior(project / "work" / "outer.yaml")
    documents = collect_documents(behavior, load_cell(project / "cells" / "cell.yaml"))
    assert (documents.behavior, documents.cell) == ("work/outer.yaml", "cells/cell.yaml")
    assert sorted(documents.texts) == ["cells/cell.yaml", "cells/entries.yaml", "lib/inner.yaml", "work/outer.yaml"]
    assert documents.texts["work/outer.yaml"] == OUTER.encode()


def test_unpacked_elsewhere_it_means_the_same(project: Path, tmp_path: Path) -> None:
    behavior = load_behavior(project / "work" / "outer.yaml")
    unpacked = collect_documents(behavior).unpack(tmp_path / "elsewhere")
    assert load_behavior(unpacked).meaning == behavior.meaning


def test_a_behavior_without_a_file_goes_along_as_json(tmp_path: Path) -> None:
    behavior = behavior_of("root: {state: test.Give, timeout: {after: 1 s, to: bad}}", file=str(tmp_path / "no.yaml"))
    unpacked = collect_documents(behavior).unpack(tmp_path / "elsewhere")
    assert load_behavior(unpacked).meaning == behavior.meaning


@pytest.mark.parametrize("name", ["../out.yaml", "/out.yaml", "a/../../out.yaml", "", ".", "a\0b"])
def test_a_name_that_leads_elsewhere_is_refused(tmp_path: Path, name: str) -> None:
    documents = RecordedDocuments(behavior=name, texts={name: b"x"})
    with pytest.raises(RecordingError):
        documents.unpack(tmp_path / "in")
    assert not (tmp_path / "out.yaml").exists()


def test_a_recording_without_its_behavior_says_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"the behavior is not in this recording \(give --behavior\)"):
        RecordedDocuments(behavior="b.yaml").unpack(tmp_path)


def test_the_digests_of_meshes_go_along(project: Path) -> None:
    """By the names that the cell has for them; the files do not."""
    cell = project / "cells" / "cell.yaml"
    (project / "cells" / "bin.stl").write_bytes(b"a mesh")
    cell.write_text(
        f"{CELL}world: {{kind: mujoco}}\nfixtures: {{bin: {{shape: mesh, file: bin.stl}}}}\n", encoding="utf-8"
    )
    documents = collect_documents(load_behavior(project / "work" / "outer.yaml"), load_cell(cell))
    assert documents.meshes == {"bin.stl": hashlib.sha256(b"a mesh").hexdigest()}
    assert "cells/bin.stl" not in documents.texts
