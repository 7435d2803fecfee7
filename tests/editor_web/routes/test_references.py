"""Around a document, over HTTP: fixes that can be sent back, referrers, moving, restoring, versions drawn."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.editor_web.editing_client import SHIFT, SHIFT_ID, EditingClient

AT = f"/documents/{SHIFT_ID}"


@pytest.fixture
def client(tmp_path: Path) -> EditingClient:
    return EditingClient(tmp_path)


async def test_a_fix_is_sent_back_as_it_came(client: EditingClient) -> None:
    text = SHIFT.replace(", c: bad}", "}")
    found = (await client.post(f"{AT}/fixes", {"text": text})).json()
    loose = next(each for each in found if each["code"] == "unconnected-outcome")
    assert (loose["path"], loose["line"]) == ("root/first", 10)
    fix = next(each for each in loose["fixes"] if each["title"] == "Connect `c` to `bad`")
    answer = (await client.post(f"{AT}/edits", {"text": text, "edits": fix["edits"]})).json()
    assert (answer["text"], answer["findings"]) == (SHIFT, [])


async def test_a_text_without_findings_or_that_cannot_be_read_has_no_fixes(client: EditingClient) -> None:
    for text in (SHIFT, "root: [", ""):
        assert (await client.post(f"{AT}/fixes", {"text": text})).json() == []


async def test_a_document_moves_with_the_references_to_it(client: EditingClient) -> None:
    outer = "flexcell: 1\nname: o\noutcomes: [good, bad]\nroot: {behavior: shift.yaml}\n"
    (client.project / "behaviors/outer.yaml").write_text(outer)
    assert (await client.get(f"{AT}/referrers")).json() == [
        {"id": "behaviors/outer.yaml", "name": "o", "paths": ["root"]}
    ]
    moved = (await client.post(f"{AT}/move", {"id": "behaviors/a/night.yaml", "follow": True})).json()
    assert (moved["document"]["id"], moved["updated"], moved["left"]) == (
        "behaviors/a/night.yaml",
        ["behaviors/outer.yaml"],
        [],
    )
    assert "behavior: a/night.yaml" in (client.project / "behaviors/outer.yaml").read_text()
    taken = await client.post("/documents/behaviors/outer.yaml/move", {"id": "behaviors/a/night.yaml", "follow": True})
    assert (taken.status_code, taken.json()["message"]) == (422, "there is a document with this id")


async def test_a_deleted_document_is_listed_and_restored(client: EditingClient) -> None:
    assert (await client.get("/deleted_documents")).json() == []
    assert (await client.http.delete(AT)).status_code == 204
    assert [each["id"] for each in (await client.get("/deleted_documents")).json()] == [SHIFT_ID]
    assert (await client.post(f"{AT}/restore", {})).json()["text"] == SHIFT
    assert client.file.read_text() == SHIFT


async def test_versions_are_drawn_and_texts_compared(client: EditingClient) -> None:
    opened = await client.opened()
    text = SHIFT.replace("duration_s: 1", "duration_s: 2")
    await client.save(text, opened["hash"])
    versions = (await client.get(f"{AT}/versions")).json()
    assert [each["by"] for each in versions] == ["editor", "file"]
    drawn = (await client.get(f"{AT}/versions/{opened['hash']}/drawn")).json()
    assert drawn["graph"]["children"][1]["parameters"] == {"duration_s": 1}
    assert (await client.get(f"{AT}/versions/{'0' * 64}/drawn")).status_code == 422
    compared = (await client.post(f"{AT}/compare", {"before": SHIFT, "after": text})).json()
    assert [(each["path"], each["change"]) for each in compared["changes"]] == [("root/second", "changed")]


async def test_a_viewer_looks_and_changes_nothing(tmp_path: Path) -> None:
    viewer = EditingClient(tmp_path, role="viewer")
    assert (await viewer.get(f"{AT}/referrers")).status_code == 200
    for path, body in (("move", {"id": "behaviors/x.yaml", "follow": False}), ("restore", {})):
        assert (await viewer.post(f"{AT}/{path}", body)).status_code == 403
    assert viewer.file.exists()


async def test_bad_ids_are_refused_in_words(client: EditingClient) -> None:
    for path in ("referrers", "move", "restore", "fixes", "compare"):
        at = f"/documents/behaviors/..%2F..%2Fetc.yaml/{path}"
        body = {"id": "behaviors/x.yaml", "follow": True, "text": "a: 1", "before": "a: 1", "after": "a: 2"}
        answer = await (client.get(at) if path == "referrers" else client.post(at, body))
        assert answer.status_code in (404, 422)
        assert answer.json()["message"]
