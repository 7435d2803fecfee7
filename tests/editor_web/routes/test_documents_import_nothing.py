"""Neither drafts nor documents nor whoever looks at them make the server import what they name."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.editor_web.editing_client import SHIFT, SHIFT_ID, EditingClient
from tests.engine.project_folder import ProjectFolder, behavior_text, is_imported

AT = f"/documents/{SHIFT_ID}"
TREE = """\
flexcell: 1
name: tree
outcomes: [success, failure]
success: [success]
root:
  tree:
    behaviour: "{name}"
"""


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A module that could be imported and would end the server."""
    folder = tmp_path / "theirs"
    folder.mkdir()
    monkeypatch.setattr(sys, "path", [str(folder), *sys.path])
    return ProjectFolder(folder).module("raise SystemExit(3)")


@pytest.mark.parametrize("text", [behavior_text("draft", "NAME:Zen"), TREE.format(name="NAME:Zen")])
async def test_a_draft_imports_nothing(tmp_path: Path, module: str, text: str) -> None:
    """Not of the standard library either; the finding says what to do."""
    client = EditingClient(tmp_path)
    before = set(sys.modules)
    for name in (module, "this"):
        draft = {"text": text.replace("NAME", name)}
        for kind in ("draft", "data_flow", "findings"):
            answer = await client.post(f"{AT}/{kind}", draft)
            assert answer.status_code < 500
        found = (await client.post(f"{AT}/draft", draft)).json()["findings"]
        assert [each["code"] for each in found] == ["module-not-allowed"]
        assert f"states: [{name}]" in found[0]["hint"]
    assert not {module, "this"} & (set(sys.modules) - before)


async def test_a_viewer_who_looks_imports_nothing(tmp_path: Path, module: str) -> None:
    """At a document that lies in the project, at the lists, and at the catalogue."""
    client = EditingClient(tmp_path, role="viewer")
    (tmp_path / SHIFT_ID).write_text(SHIFT.replace("flow.Wait", f'"{module}:Zen"'), encoding="utf-8")
    opened = await client.get(AT)
    assert (opened.status_code, [each["code"] for each in opened.json()["findings"]]) == (200, ["module-not-allowed"])
    for path in ("/documents", "/catalogue", "/behaviors", f"/behaviors/{SHIFT_ID}"):
        assert (await client.get(path)).status_code < 500
    assert not is_imported(module)
