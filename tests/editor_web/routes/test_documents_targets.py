"""Targets over HTTP: looked at beside edits, for the document's own cell, which also offers its names."""

from __future__ import annotations

from pathlib import Path

from engine.editing import DocumentRepository
from engine.registry import load_states
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.engine.editing.target_texts import FAR, ID, REACH, written


async def test_an_edit_is_answered_while_targets_are_looked_at(tmp_path: Path, serve: Serve) -> None:
    """The findings come from a process that had not even started."""
    written(tmp_path)
    async with serve(FakeBackend(documents=DocumentRepository(tmp_path, load_states()))) as served:
        at = f"api/v1/documents/{ID}"
        edits = [{"edit": "rename_node", "path": "root/go", "name": "reach"}]
        edited = await served.http.post(f"{at}/edits", json={"text": FAR, "edits": edits, "check": False})
        found = (await served.http.post(f"{at}/targets", json={"text": edited.json()["text"], "page": "p"})).json()
        assert [(each["severity"], each["code"], each["path"]) for each in found["findings"]] == [
            ("warning", "unreachable-target", "root/reach")
        ]
        assert (found["problem"], found["dropped"]) == ("", False)


async def test_a_text_without_a_cell_starts_no_process(tmp_path: Path, serve: Serve) -> None:
    """Nor does one that cannot be read."""
    written(tmp_path)
    async with serve(FakeBackend(documents=DocumentRepository(tmp_path, load_states()))) as served:
        for text in (FAR.replace("cell: bench.yaml\n", ""), "root: ["):
            answer = await served.http.post(f"api/v1/documents/{ID}/targets", json={"text": text, "page": "p"})
            assert answer.json() == {"findings": [], "problem": "", "dropped": False}


async def test_names_are_those_of_the_cell_that_the_text_names(tmp_path: Path, serve: Serve) -> None:
    """Without one those of the open cell, which is none here; a cell that cannot be read offers none."""
    written(tmp_path)
    names: dict[str, list[str] | None] = {}
    async with serve(FakeBackend(documents=DocumentRepository(tmp_path, load_states()))) as served:
        for cell in ("cell: bench.yaml\n", "", "cell: missing.yaml\n", "cell: ../../elsewhere.yaml\n"):
            text = REACH.replace("cell: bench.yaml\n", cell)
            answer = await served.http.post(f"api/v1/documents/{ID}/names", json={"text": text})
            names[cell] = answer.json().get("robot")
    assert list(names.values()) == [["left"], None, None, None]
