"""The scene of the cell over HTTP: a file for other programs, also for who only looks; another format is refused."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import httpx

from editor_web.app import new_app
from editor_web.security.authentication import load_access_tokens
from engine.cell import OpenCell
from engine.document.cell import load_cell
from tests.editor_web.fake_backend import FakeBackend

HOST = "127.0.0.1:8642"
CELL = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nfixtures:\n  table: {shape: box, size_m: [1, 1, 0.1]}\n"


def client(folder: Path) -> httpx.AsyncClient:
    file = folder / "bench.yaml"
    file.write_text(CELL, encoding="utf-8")
    backend = FakeBackend()
    backend.cell = cast("OpenCell", SimpleNamespace(document=load_cell(file)))
    access = load_access_tokens(folder / "tokens")
    return httpx.AsyncClient(
        transport=httpx.ASGITransport(app=new_app(backend, access=access, hosts=frozenset({HOST}), port=8642)),
        base_url=f"http://{HOST}/api/v1",
        headers={"Authorization": f"Bearer {access.viewer}"},
    )


async def test_the_scene_is_downloaded_under_the_name_of_the_cell(tmp_path: Path) -> None:
    async with client(tmp_path) as http:
        answer = await http.get("/cell/scene", params={"format": "glb"})
        assert (answer.status_code, answer.headers["content-type"]) == (200, "model/gltf-binary")
        assert answer.headers["content-disposition"] == 'attachment; filename="bench.glb"'
        assert answer.content[:4] == b"glTF"


async def test_what_is_no_format_or_no_cell_is_refused_with_the_reason(tmp_path: Path) -> None:
    async with client(tmp_path) as http:
        assert (await http.get("/cell/scene", params={"format": "step"})).status_code == 422
        (tmp_path / "bench.yaml").write_text(CELL.replace("1, 0.1]", "1]"), encoding="utf-8")
        answer = await http.get("/cell/scene", params={"format": "xml"})
        assert answer.status_code == 422
        assert answer.json()["message"] == "the size of a box has 3 lengths, not 2"
        assert answer.json()["where"].endswith("bench.yaml:5:31")
