"""Search by name over HTTP."""

from __future__ import annotations

from tests.editor_web.conftest import Serve
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
    }
    assert none == []
