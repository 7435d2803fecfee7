"""The items of the open cell over HTTP."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

from engine.bus import SkillBus
from engine.cell import OpenCell
from engine.clock import LoopClock
from engine.document.cell import load_cell
from engine.messages import GripperState
from engine.project import BusInspector
from engine.skills.device_moves import DeviceReading
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda, gripper: {model: panda_hand}}
"""


async def test_a_viewer_reads_the_items_with_their_lines_and_topics(serve: Serve, tmp_path: Path) -> None:
    (tmp_path / "bench.yaml").write_text(CELL, encoding="utf-8")
    backend = FakeBackend()
    backend.cell = cast("OpenCell", SimpleNamespace(document=load_cell(tmp_path / "bench.yaml")))
    async with SkillBus(LoopClock()) as bus, serve(backend) as served:
        backend.known_inspector = BusInspector(bus)
        bus.topic("left/gripper/state", GripperState)
        headers = {"Authorization": f"Bearer {served.access.viewer}"}
        answer = await served.http.get("/api/v1/cell/items", headers=headers)
    body = answer.json()
    assert (answer.status_code, body["file"], body["changed"]) == (200, "bench.yaml", False)
    assert [item["path"] for item in body["items"]] == ["robots/left", "robots/left/gripper", "world"]
    assert body["items"][1] == {
        "path": "robots/left/gripper",
        "kind": "tool",
        "name": "left",
        "model": "panda_hand",
        "owner": "robots/left",
        "topics": ["left/gripper/state"],
        "text": "left: {model: panda, gripper: {model: panda_hand}}",
        "line": 5,
        "file": "",
    }


async def test_an_editor_of_the_cell_reads_which_models_there_are(serve: Serve) -> None:
    async with serve(FakeBackend()) as served:
        headers = {"Authorization": f"Bearer {served.access.viewer}"}
        body = (await served.http.get("/api/v1/cell/models", headers=headers)).json()
    assert {"panda", "ur10", "irb4600"} <= set(body["robots"])
    assert {"panda_hand", "magnet"} <= set(body["tools"])


async def test_a_device_stands_below_its_module_with_its_positions_lines_and_topics(serve: Serve) -> None:
    backend = FakeBackend()
    cells = Path(__file__).parents[3] / "behaviors" / "cells"
    backend.cell = cast("OpenCell", SimpleNamespace(document=load_cell(cells / "vice.yaml")))
    async with SkillBus(LoopClock()) as bus, serve(backend) as served:
        backend.known_inspector = BusInspector(bus)
        bus.topic("vice/jaws/state", DeviceReading)
        headers = {"Authorization": f"Bearer {served.access.viewer}"}
        items = (await served.http.get("/api/v1/cell/items", headers=headers)).json()["items"]
    jaws = next(item for item in items if item["path"] == "devices/vice/jaws")
    assert (jaws["kind"], jaws["model"], jaws["owner"]) == ("device", "open, closed", "modules/vice")
    assert (jaws["topics"], jaws["file"]) == (["vice/jaws/state"], "../modules/vice/module.yaml")
    assert jaws["text"].startswith("jaws:")
