"""Documents over HTTP: drafts, edits, saving without overwriting anybody, versions, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.editor_web.editing_client import SHIFT, SHIFT_ID, EditingClient

AT = f"/documents/{SHIFT_ID}"


class Endless(httpx.AsyncByteStream):
    """A body that goes on for ever and does not say how long it is."""

    def __aiter__(self) -> Endless:
        return self

    async def __anext__(self) -> bytes:
        return b" " * 100_000


@pytest.fixture
def client(tmp_path: Path) -> EditingClient:
    return EditingClient(tmp_path)


async def test_a_document_is_opened_with_all_that_the_page_draws(client: EditingClient) -> None:
    opened = await client.opened()
    assert (opened["id"], opened["text"], opened["findings"]) == (SHIFT_ID, SHIFT, [])
    assert opened["document"]["outcomes"] == ["good", "bad"]
    first, second = opened["graph"]["children"]
    assert (first["path"], first["state"], first["line"], first["column"]) == ("root/first", "test.Give", 10, 7)
    assert first["targets"] == {"a": "second", "b": "second", "c": "bad"}
    assert (second["parameters"], second["line"], second["end_line"]) == ({"duration_s": 1}, 11, 14)
    assert opened["graph"]["transitions"][0] == {"source": "first", "outcome": "a", "target": "second"}


async def test_a_draft_that_cannot_be_read_says_where(client: EditingClient) -> None:
    answer = (await client.post(f"{AT}/draft", {"text": SHIFT.replace("states:", "states: [")})).json()
    assert (answer["graph"], answer["document"]) == (None, None)
    assert answer["findings"][0]["line"] >= 9
    assert client.file.read_text() == SHIFT


async def test_a_draft_with_mistakes_is_drawn_all_the_same(client: EditingClient) -> None:
    """An unknown key, an unknown state, a missing initial state: what is there can be seen and mended."""
    text = SHIFT.replace("initial: first", "colour: red").replace("flow.Wait", "flow.Wiat")
    answer = (await client.post(f"{AT}/draft", {"text": text})).json()
    assert [child["name"] for child in answer["graph"]["children"]] == ["first", "second"]
    assert answer["findings"][0]["code"] == "invalid-document"
    text = SHIFT.replace("flow.Wait", "flow.Wiat")
    answer = (await client.post(f"{AT}/draft", {"text": text})).json()
    assert [(f["code"], f["path"], f["line"]) for f in answer["findings"]] == [("unknown-state", "root/second", 12)]


async def test_edits_come_back_as_text_graph_and_findings(client: EditingClient) -> None:
    edit = {"edit": "add_node", "parent": "root", "kind": "state", "runs": "test.Give", "name": "third"}
    answer = (await client.post(f"{AT}/edits", {"text": SHIFT, "edits": [edit]})).json()
    assert answer["text"] == SHIFT + "      third:\n        state: test.Give\n"
    assert (answer["changed"], answer["refused"]) == (["root/third"], None)
    assert answer["graph"]["children"][2]["exits"] == ["a", "b", "c"]
    assert "unreachable-node" in [finding["code"] for finding in answer["findings"]]
    assert client.file.read_text() == SHIFT


async def test_an_edit_that_cannot_be_made_changes_nothing_and_says_why(client: EditingClient) -> None:
    edits = [
        {"edit": "rename_node", "path": "root/first", "name": "one"},
        {"edit": "remove_nodes", "paths": ["root/x"]},
    ]
    answer = (await client.post(f"{AT}/edits", {"text": SHIFT, "edits": edits})).json()
    assert answer["text"] == SHIFT
    assert (answer["refused"]["message"], answer["refused"]["index"]) == ("there is no node `root/x`", 1)


@pytest.mark.parametrize(
    ("wrong", "where"),
    [
        ({"edit": "explode"}, "edits.1.edit"),
        ({"edit": "set_initial", "path": "root", "child": "a b"}, "edits.1.child"),
        ({"edit": "ungroup", "path": "root", "name": "x"}, "edits.1.name"),
    ],
)
async def test_what_is_no_edit_is_no_body_and_says_where(client: EditingClient, wrong: Any, where: str) -> None:
    edits = [{"edit": "rename_node", "path": "root/first", "name": "one"}, wrong]
    answer = await client.post(f"{AT}/edits", {"text": SHIFT, "edits": edits})
    assert (answer.status_code, answer.json()["where"]) == (422, where)


async def test_nodes_are_copied_as_yaml_and_pasted_elsewhere(client: EditingClient) -> None:
    yaml = (await client.post(f"{AT}/copy", {"text": SHIFT, "paths": ["root/second"]})).json()["yaml"]
    assert yaml == "second:\n  state: flow.Wait\n  with: {duration_s: 1}\n  transitions: {done: good}\n"
    edit = {"edit": "paste", "parent": "root", "yaml": yaml, "position": [1, 2]}
    answer = (await client.post(f"{AT}/edits", {"text": SHIFT, "edits": [edit]})).json()
    assert answer["changed"] == ["root/second_2"]
    assert answer["text"].endswith("transitions: {done: good}\nview: {root/second_2: [1, 2]}\n")


async def test_saving_writes_the_text_and_keeps_versions(client: EditingClient) -> None:
    opened = await client.opened()
    text = SHIFT.replace("duration_s: 1", "duration_s: 2")
    saved = await client.save(text, opened["hash"])
    assert saved.status_code == 200
    assert client.file.read_text() == text
    versions = (await client.get(f"{AT}/versions")).json()
    assert [(each["hash"], each["current"]) for each in versions] == [
        (saved.json()["hash"], True),
        (opened["hash"], False),
    ]
    old = (await client.get(f"{AT}/versions/{opened['hash']}")).json()
    assert old["text"] == SHIFT
    difference = (await client.get(f"{AT}/diff", **{"from": opened["hash"], "to": saved.json()["hash"]})).json()
    assert difference["changes"] == [
        {
            "path": "root/second",
            "change": "changed",
            "before_path": None,
            "fields": [{"field": "with.duration_s", "before": 1, "after": 2}],
        }
    ]


async def test_what_changed_on_disk_is_merged_and_never_overwritten(client: EditingClient) -> None:
    opened = await client.opened()
    theirs = SHIFT.replace("name: shift", "name: night shift")
    client.file.write_text(theirs)
    answer = await client.save(SHIFT.replace("duration_s: 1", "duration_s: 2"), opened["hash"])
    assert answer.status_code == 409
    body = answer.json()
    merge = body["merge"]
    assert (body["theirs"], merge["conflicts"]) == (theirs, [])
    assert merge["text"] == theirs.replace("duration_s: 1", "duration_s: 2")
    assert client.file.read_text() == theirs
    again = await client.save(merge["text"], body["theirs_hash"])
    assert again.status_code == 200
    assert client.file.read_text() == merge["text"]


async def test_a_field_that_both_changed_is_decided_and_neither_text_is_lost(client: EditingClient) -> None:
    opened = await client.opened()
    theirs, mine = (SHIFT.replace("duration_s: 1", f"duration_s: {number}") for number in (3, 2))
    client.file.write_text(theirs)
    merge = (await client.save(mine, opened["hash"])).json()["merge"]
    assert [(each["path"], each["field"], each["mine"], each["theirs"]) for each in merge["conflicts"]] == [
        ("root/second", "with.duration_s", 2, 3)
    ]
    sides = {"root/second with.duration_s": "theirs"}
    body = {"text": mine, "base_hash": opened["hash"], "sides": sides}
    chosen = (await client.post(f"/documents/{SHIFT_ID}/merge", body)).json()
    assert chosen["merge"]["text"] == theirs
    kept = [client.documents.version(SHIFT_ID, each.hash) for each in client.documents.versions(SHIFT_ID)]
    assert kept == [theirs, mine, SHIFT]


async def test_a_base_that_nobody_knows_is_not_merged(client: EditingClient) -> None:
    answer = await client.save(SHIFT + "# more\n", "0" * 64)
    assert (answer.status_code, answer.json()["merge"]) == (409, None)
    assert client.file.read_text() == SHIFT


async def test_documents_are_made_renamed_copied_and_deleted(client: EditingClient) -> None:
    made = await client.post(
        "/documents", {"id": "behaviors/new/one.yaml", "template": "sequence", "name": "one: more"}
    )
    assert made.status_code == 201
    assert made.json()["document"]["name"] == "one: more"
    assert (await client.post("/documents", {"id": "behaviors/new/one.yaml"})).status_code == 422
    moved = await client.post("/documents/behaviors/new/one.yaml/rename", {"id": "behaviors/new/two.yaml"})
    assert moved.json()["id"] == "behaviors/new/two.yaml"
    copy = await client.post("/documents/behaviors/new/two.yaml/duplicate", {"id": "behaviors/three.yaml"})
    assert (copy.status_code, copy.json()["text"]) == (201, made.json()["text"])
    gone = await client.http.delete("/documents/behaviors/new/two.yaml")
    assert gone.status_code == 204
    assert not (client.project / "behaviors/new/two.yaml").exists()
    assert (await client.get("/documents/behaviors/new/two.yaml")).status_code == 404
    versions = (await client.get("/documents/behaviors/new/two.yaml/versions")).json()
    assert [each["hash"] for each in versions] == [made.json()["hash"]]


@pytest.mark.parametrize("template", ["machine", "sequence", "concurrency"])
async def test_a_new_document_is_filled_by_edits_alone(client: EditingClient, template: str) -> None:
    made = (await client.post("/documents", {"id": "behaviors/x.yaml", "template": template})).json()
    parent = {"sequence": "root/sequence"}.get(template, "root")
    edits: list[Any] = [
        {
            "edit": "add_node",
            "parent": parent,
            "kind": "state",
            "runs": "flow.Wait",
            "parameters": {"duration_s": 1},
            "name": n,
        }
        for n in ("one", "two")
    ]
    if template == "machine":
        edits += [
            {"edit": "set_transition", "path": "root/one", "outcome": "done", "target": "two"},
            {"edit": "set_transition", "path": "root/two", "outcome": "done", "target": "finished"},
            {"edit": "set_document", "changes": {"outcomes": ["finished"]}},
        ]
    if template == "concurrency":
        rules = [{"finished": {"one": "done", "two": "done"}}]
        edits += [
            {"edit": "set_field", "path": "root", "field": "conditions", "value": rules},
            {"edit": "set_document", "changes": {"outcomes": ["finished"]}},
        ]
    answer = (await client.post("/documents/behaviors/x.yaml/edits", {"text": made["text"], "edits": edits})).json()
    assert answer["refused"] is None
    assert [f for f in answer["findings"] if f["severity"] == "error"] == []


async def test_the_catalogue_has_states_containers_and_behaviors(client: EditingClient) -> None:
    catalogue = (await client.get("/catalogue")).json()
    wait = next(state for state in catalogue["states"] if state["name"] == "flow.Wait")
    assert (wait["group"], wait["outcomes"]) == ("flow", ["done"])
    assert wait["parameters"][0]["schema"]["unit"] == "s"
    assert [each["id"] for each in catalogue["behaviors"]] == [SHIFT_ID]
    kinds = [each["kind"] for each in catalogue["containers"]]
    assert kinds[:2] == ["machine", "concurrency"]
    assert (catalogue["entries"], catalogue["names"]) == ([], {})


async def test_the_source_of_a_state_is_given_and_that_of_nothing_else(client: EditingClient) -> None:
    """Whatever path is asked for."""
    found = (await client.get("/catalogue/states/flow.Wait/source")).json()
    assert found["text"].splitlines()[found["line"] - 1].startswith("class Wait(")
    for name in ("flow.Gone", "/etc/passwd", "..%2f..%2fetc%2fpasswd", "engine.registry:Path", "os:PathLike"):
        answer = await client.get(f"/catalogue/states/{name}/source")
        assert (answer.status_code, "text" in answer.json()) == (404, False)


@pytest.mark.parametrize(
    "document_id",
    [
        "behaviors/../tokens",
        "behaviors/../../etc/passwd.yaml",
        "behaviors/%2e%2e/tokens.yaml",
        "behaviors/..%2ftokens.yaml",
        "/etc/passwd.yaml",
        "behaviors//etc/passwd.yaml",
        "behaviors/a.yaml%00.yaml",
        "behaviors/shift.breakpoints.yaml",
        "tokens",
        "behaviors/shift.txt",
        f"behaviors/{'x' * 300}.yaml",
    ],
)
async def test_nothing_outside_of_the_behaviors_is_read_or_written(client: EditingClient, document_id: str) -> None:
    before = sorted(path for path in client.project.rglob("*") if ".flexcell" not in path.parts)
    assert (await client.get(f"/documents/{document_id}")).status_code in (400, 404, 422)
    body = {"text": SHIFT, "base_hash": "0" * 64}
    assert (await client.http.put(f"/documents/{document_id}", json=body)).status_code in (400, 404, 405, 422)
    assert (await client.http.delete(f"/documents/{document_id}")).status_code in (400, 404, 405, 422)
    assert (await client.post("/documents", {"id": document_id})).status_code in (404, 422) or "%" in document_id
    assert (await client.post(f"{AT}/rename", {"id": document_id})).status_code in (404, 422)
    assert sorted(path for path in client.project.rglob("*") if ".flexcell" not in path.parts) == before


async def test_a_link_out_of_the_project_leads_nowhere(
    client: EditingClient, tmp_path_factory: pytest.TempPathFactory
) -> None:
    outside = tmp_path_factory.mktemp("outside") / "secret.yaml"
    outside.write_text(SHIFT)
    (client.project / "behaviors" / "link.yaml").symlink_to(outside)
    assert (await client.get("/documents/behaviors/link.yaml")).status_code == 404


async def test_a_draft_makes_nobody_read_files_outside_of_the_project(client: EditingClient) -> None:
    for text in (
        SHIFT.replace("state: flow.Wait\n        with: {duration_s: 1}", "behavior: ../../../../etc/passwd"),
        SHIFT.replace("# What it", "cell: /etc/passwd\n# What it"),
    ):
        answer = (await client.post(f"{AT}/draft", {"text": text})).json()
        assert [finding["message"].partition("` ")[2] for finding in answer["findings"]] == ["leads out of the project"]


async def test_what_is_no_document_is_not_saved(client: EditingClient) -> None:
    opened = await client.opened()
    for text in ("", "- a\n", "a: [", "a: *b", "cell: x\nrobots: {}\n"):
        assert (await client.save(text, opened["hash"])).status_code == 422
    assert (await client.save("x" * 2_100_000, opened["hash"])).status_code == 422
    assert client.file.read_text() == SHIFT


async def test_an_oversized_body_is_refused_unread(client: EditingClient) -> None:
    headers = {"content-type": "application/json"}
    address = f"{client.http.base_url}{AT[1:]}/draft"
    own = {"host": "127.0.0.1:8642", "authorization": client.http.headers["authorization"], **headers}
    endless = httpx.Request("POST", address, headers=own, stream=Endless())
    answer = await client.http.send(endless)
    assert answer.status_code == 413
    answer = await client.http.post(f"{AT}/draft", content=b"{}", headers={**headers, "content-length": "99999999"})
    assert answer.status_code == 413


async def test_a_viewer_reads_and_changes_nothing(tmp_path: Path) -> None:
    viewer = EditingClient(tmp_path, role="viewer")
    assert (await viewer.get(AT)).status_code == 200
    for path in ("", "/draft", "/edits", "/copy", "/rename", "/duplicate"):
        assert (await viewer.post(f"{AT}{path}", {})).status_code == 403, path
    assert (await viewer.save(SHIFT, "0" * 64)).status_code == 403
    assert (await viewer.http.delete(AT)).status_code == 403


async def test_without_a_token_and_from_other_pages_nothing_is_answered(client: EditingClient) -> None:
    bare = client.http
    bare.headers.pop("Authorization")
    for path in (AT, f"{AT}/versions", "/catalogue"):
        assert (await bare.get(path)).status_code == 401
    cookie = {"Cookie": f"flexcell_session_8642={client.sessions.begin('operator')}"}
    evil = {**cookie, "Origin": "http://evil.example"}
    assert (await bare.put(AT, json={"text": SHIFT, "base_hash": "0" * 64}, headers=evil)).status_code == 403
    assert (await bare.get(AT, headers={**cookie, "Host": "evil.example"})).status_code == 421


async def test_the_drawing_of_the_page_becomes_a_pdf_and_nothing_else_does(client: EditingClient) -> None:
    pytest.importorskip("reportlab", reason="what writes PDF is not installed")
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><rect x="0" y="0" width="9" height="9"></rect></svg>'
    )
    made = await client.post(f"{AT}/pdf", {"svg": svg})
    assert (made.status_code, made.headers["content-type"]) == (200, "application/pdf")
    assert made.content.startswith(b"%PDF-")
    refused = await client.post(f"{AT}/pdf", {"svg": svg.replace("rect", "image")})
    assert refused.status_code == 422
    assert refused.json()["message"] == "an SVG with <image> is none of a behavior"
