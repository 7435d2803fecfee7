"""Answers with whole documents are the structs that their routes name: whoever reads them finds every field."""

from __future__ import annotations

from pathlib import Path

import msgspec

from benchmarks.large_document import large_document
from editor_web.http_bodies.document_bodies import DocumentBody
from engine.editing import DocumentAnalysis
from engine.editing.draft_cache import EditAnswer
from tests.editor_web.editing_client import EditingClient

ID = "behaviors/large.yaml"


async def test_answers_of_documents_have_the_fields_of_their_structs(tmp_path: Path) -> None:
    client = EditingClient(tmp_path)
    made = (await client.post("/documents", {"id": ID, "name": "large"})).json()
    text = large_document(40)
    edits = [{"edit": "duplicate", "paths": ["root/area_0"]}, {"edit": "rename_node", "path": "root", "name": "x"}]
    at = f"/documents/{ID}"
    for check in (True, False):
        drawn = await client.post(f"{at}/draft", {"text": text, "check": check})
        assert msgspec.json.decode(drawn.content, type=DocumentAnalysis).checked is check
        for some in (edits[:1], edits):
            edited = await client.post(f"{at}/edits", {"text": text, "edits": some, "check": check})
            done = msgspec.json.decode(edited.content, type=EditAnswer)
            assert (done.refused is None) == (len(some) == 1)
    opened = msgspec.json.decode((await client.get(at)).content, type=DocumentBody)
    assert opened.text == made["text"]
    found = await client.post(f"{at}/findings", {"text": text.replace("flow.Decide", "flow.Nothing", 1)})
    assert [each["code"] for each in found.json()] == ["unknown-state"]
