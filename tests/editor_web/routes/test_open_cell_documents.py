"""Documents of the cell over HTTP: for operators, with versions and findings; the open cell stays as it was."""

from __future__ import annotations

from pathlib import Path

import httpx
import pytest

from editor_web.app import new_app
from editor_web.security.authentication import load_access_tokens
from engine.document.cell import load_cell
from engine.editing import DocumentRepository
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.engine.editing.cells.cell_texts import CELL, write_cell

HOST = "127.0.0.1:8642"
AT = "/cell_documents/behaviors/cells/bench.yaml"
RENAMED = {"edit": "rename_item", "section": "frames", "name": "slot", "new_name": "nest"}


def client(folder: Path, *, role: str = "operator") -> httpx.AsyncClient:
    file = folder / "behaviors" / "cells" / "bench.yaml"
    cell = load_cell(file if file.exists() else write_cell(folder))
    backend = FakeBackend(documents=DocumentRepository(folder, {}, cell=cell))
    access = load_access_tokens(folder / "tokens")
    token = access.operator if role == "operator" else access.viewer
    return httpx.AsyncClient(
        transport=httpx.ASGITransport(app=new_app(backend, access=access, hosts=frozenset({HOST}), port=8642)),
        base_url=f"http://{HOST}/api/v1",
        headers={"Authorization": f"Bearer {token}"},
    )


async def test_a_cell_is_opened_edited_and_saved(tmp_path: Path) -> None:
    async with client(tmp_path) as http:
        assert [each["kind"] for each in (await http.get("/cell_documents")).json()] == ["cell", "module"]
        opened = (await http.get(AT)).json()
        assert (opened["draft"]["text"], opened["draft"]["findings"]) == (CELL, [])
        answer = (await http.post(f"{AT}/edits", json={"text": CELL, "edits": [RENAMED]})).json()
        made = answer["draft"]["text"]
        assert answer["refused"] is None
        assert made == CELL.replace("slot:", "nest:").replace("frame: slot", "frame: nest")
        assert (tmp_path / "behaviors" / "cells" / "bench.yaml").read_text() == CELL
        saved = await http.put(AT, json={"text": made, "base_hash": opened["draft"]["hash"]})
        assert saved.json()["hash"] == answer["draft"]["hash"]
    assert (tmp_path / "behaviors" / "cells" / "bench.yaml").read_text() == made


async def test_a_refused_edit_and_a_wrong_text_say_why(tmp_path: Path) -> None:
    async with client(tmp_path) as http:
        again = {"text": CELL, "edits": [{**RENAMED, "new_name": "floor"}]}
        answer = (await http.post(f"{AT}/edits", json=again)).json()
        assert answer["refused"]["message"] == "`floor` is already a name in `fixtures`"
        assert answer["draft"]["text"] == CELL
        bad = (await http.post(f"{AT}/edits", json={"text": CELL, "edits": [{**RENAMED, "new_name": "Floor"}]})).json()
        assert "message" in bad
        draft = (await http.post(f"{AT}/draft", json={"text": CELL.replace("frame: slot}", "frame: slut}")})).json()
        assert draft["findings"][0]["path"] in ("parts/plate", "cameras/above")


async def test_a_change_on_disk_is_a_conflict(tmp_path: Path) -> None:
    async with client(tmp_path) as http:
        base = (await http.get(AT)).json()["draft"]["hash"]
        (tmp_path / "behaviors" / "cells" / "bench.yaml").write_text(CELL.replace("0.80", "0.85"))
        answer = await http.put(AT, json={"text": CELL.replace("0.80", "0.81"), "base_hash": base})
        assert (answer.status_code, answer.json()["merge"]) == (409, None)
        assert "0.85" in answer.json()["theirs"]


@pytest.mark.parametrize("address", ["behaviors/cells/other.yaml", "flexcell.yaml", "%2e%2e/module.yaml"])
async def test_other_files_are_not_there(tmp_path: Path, address: str) -> None:
    async with client(tmp_path) as http:
        assert (await http.get(f"/cell_documents/{address}")).status_code == 404


async def test_a_viewer_reads_and_changes_nothing(tmp_path: Path) -> None:
    async with client(tmp_path, role="viewer") as http:
        opened = await http.get(AT)
        assert opened.status_code == 200
        body = {"text": CELL + "# more\n", "base_hash": opened.json()["draft"]["hash"]}
        assert (await http.put(AT, json=body)).status_code == 403
    assert (tmp_path / "behaviors" / "cells" / "bench.yaml").read_text() == CELL


async def test_behaviors_that_name_an_item_are_listed(tmp_path: Path) -> None:
    async with client(tmp_path, role="viewer") as http:
        answer = await http.get("/cell/naming_behaviors", params={"name": "plate"})
        assert (answer.status_code, answer.json()) == (200, [])
        assert (await http.get("/cell/naming_behaviors")).status_code == 422


async def test_what_touches_at_rest_is_reported_of_a_draft_and_of_no_module(tmp_path: Path, serve: Serve) -> None:
    cell = load_cell(write_cell(tmp_path))
    sunk = CELL.replace("at: {xyz: [0, 0, 0.005], frame: slot}", "at: {xyz: [0, 0, 0], frame: slot}")
    async with serve(FakeBackend(documents=DocumentRepository(tmp_path, {}, cell=cell))) as served:
        at = f"api/v1{AT}/rest"
        found = (await served.http.post(at, json={"text": sunk, "page": "mine"})).json()
        assert (found["problem"], found["dropped"]) == ("", False)
        assert {"fixtures/table", "parts/plate"} <= {each["path"] for each in found["findings"]}
        module = at.replace("bench.yaml", "bin/module.yaml")
        assert (await served.http.post(module, json={"text": "x", "page": "mine"})).json()["findings"] == []
