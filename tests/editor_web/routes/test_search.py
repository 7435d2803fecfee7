"""Search by name over HTTP."""

from __future__ import annotations

from pathlib import Path

from engine.bus import SkillBus
from engine.clock import LoopClock
from engine.editing import DocumentRepository
from engine.messages import GripperState
from engine.project import BusInspector
from engine.registry import load_states
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_behaviors import TRANSFER


async def test_behaviors_and_their_nodes_are_found_by_their_names(serve: Serve) -> None:
    async with serve() as served:
        hits = (await served.http.get("/api/v1/search", params={"text": "pick"})).json()
        none = (await served.http.get("/api/v1/search", params={"text": "no such thing"})).json()
    assert hits[0] == {
        "kind": "node",
        "id": TRANSFER.id,
        "path": "root/pick",
        "title": "pick",
        "detail": hits[0]["detail"],
        "icon": "split",
    }
    assert none == []


async def test_items_of_the_cell_and_their_topics_are_found(serve: Serve) -> None:
    backend = FakeBackend()
    async with SkillBus(LoopClock()) as bus, serve(backend) as served:
        backend.known_inspector = BusInspector(bus)
        bus.topic("left/gripper/state", GripperState)
        item = (await served.http.get("/api/v1/search", params={"text": "hca_north part"})).json()
        topic = (await served.http.get("/api/v1/search", params={"text": "gripper/state"})).json()
    assert [(hit["kind"], hit["id"]) for hit in item] == [("item", "parts/hca_north")]
    assert [(hit["kind"], hit["id"], hit["path"]) for hit in topic] == [
        ("topic", "robots/left/gripper", "left/gripper/state")
    ]


async def test_states_are_found_and_where_behaviors_use_them(serve: Serve, tmp_path: Path) -> None:
    (tmp_path / "behaviors").mkdir()
    text = "flexcell: 1\nname: wait\noutcomes: [done]\nroot: {state: flow.Wait, with: {duration_s: 1}}\n"
    (tmp_path / "behaviors" / "wait.yaml").write_text(text, encoding="utf-8")
    async with serve(FakeBackend(documents=DocumentRepository(tmp_path, load_states()))) as served:
        hit = (await served.http.get("/api/v1/search", params={"text": "flow.wait"})).json()[0]
        asked = {"kind": "state", "name": hit["id"]}
        usages = (await served.http.get("/api/v1/search/usages", params=asked)).json()
        wrong = await served.http.get("/api/v1/search/usages", params={"kind": "color", "name": "red"})
    assert (hit["kind"], hit["id"], hit["icon"]) == ("state", "flow.Wait", "flow")
    assert [(each["document"], each["path"], each["line"]) for each in usages["found"]] == [
        ("behaviors/wait.yaml", "root", 4)
    ]
    assert wrong.status_code == 422
