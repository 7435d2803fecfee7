"""The catalogue over HTTP."""

from __future__ import annotations

from tests.editor_web.conftest import Serve
from tests.editor_web.fake_behaviors import BROKEN, SINGLE, TRANSFER


async def test_all_behaviors_are_listed_with_their_problems(serve: Serve) -> None:
    """Broken ones too, sorted by id."""
    async with serve() as served:
        listed = (await served.http.get("/api/v1/behaviors")).json()
    assert [(b["id"], b["errors"], b["warnings"]) for b in listed] == [
        (BROKEN.id, 1, 0),
        (SINGLE.id, 0, 1),
        (TRANSFER.id, 0, 0),
    ]


async def test_one_behavior_comes_with_form_and_nested_graph(serve: Serve) -> None:
    """Ids have slashes; schemas keep their units; machines keep their arrows."""
    async with serve() as served:
        body = (await served.http.get(f"/api/v1/behaviors/{TRANSFER.id}")).json()
    assert body["parameters"][1]["schema"]["unit"] == "m"
    pick = next(child for child in body["graph"]["children"] if child["name"] == "pick")
    assert pick["kind"] == "concurrency"
    assert [child["path"] for child in pick["children"]] == ["root/pick/left", "root/pick/right"]
    assert pick["children"][0]["transitions"][0] == {"source": "descend", "outcome": "reached", "target": "grasp"}


async def test_a_document_that_cannot_be_read_still_has_a_page(serve: Serve) -> None:
    """No graph, but where it is wrong."""
    async with serve() as served:
        body = (await served.http.get(f"/api/v1/behaviors/{BROKEN.id}")).json()
    assert body["graph"] is None
    assert body["findings"][0]["hint"] == "did you mean motion.MoveJoints?"


async def test_an_unknown_behavior_is_not_found(serve: Serve) -> None:
    """404, and paths out of the project are just unknown names."""
    async with serve() as served:
        for name in ("none.yaml", "..%2f..%2fetc%2fpasswd"):
            assert (await served.http.get(f"/api/v1/behaviors/{name}")).status_code == 404
