"""Whatever is sent to the routes of documents, nobody gets a traceback, and nothing is written unasked."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.editor_web.editing_client import SHIFT, SHIFT_ID, EditingClient
from tests.engine.editing.layouts import Plain
from tests.engine.editing.random_edits import any_edits
from tests.tiers import examples

AT = f"/documents/{SHIFT_ID}"
PATHS = ["root", "root/first", "root/second"]
plain = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=12),
    lambda inside: st.lists(inside, max_size=4) | st.dictionaries(st.text(max_size=8), inside, max_size=4),
    max_leaves=12,
)
texts = st.one_of(
    st.just(SHIFT),
    st.text(max_size=60),
    st.sampled_from(
        [
            "a: &x 1",
            "- 1",
            "[" * 500,
            "{" * 70,
            "\ud800",
            "\x00",
            "? [a]\n: b",
            "root: {}",
            "root: 3",
            "root: {machine: 4}",
            "root: {tree: {tree: {}}}",
            "flexcell: 1\nroot: {machine: {states: {a: 3, b: {state: 4}}}}",
            "root: {sequence: [1, {state: [x]}]}",
            "root: {concurrency: {states: [], conditions: [3, {a: 4}]}}\nview: 3\nnotes: []",
            'root: {state: "os:system"}',
            'root: {behavior: "\\0"}',
            "root: {state: 5, with: [], in: 3, transitions: {a: [b]}}\nview: {root: [a, b, c]}",
        ]
    ),
)
ROUTES = [
    ("POST", f"{AT}/draft"), ("POST", f"{AT}/edits"), ("POST", f"{AT}/copy"), ("PUT", AT), ("POST", "/documents"),
    ("POST", f"{AT}/rename"), ("POST", f"{AT}/duplicate"), ("GET", f"{AT}/diff"), ("GET", f"{AT}/versions/x"),
    ("POST", f"{AT}/fixes"), ("POST", f"{AT}/compare"), ("POST", f"{AT}/move"), ("GET", f"{AT}/versions/x/drawn"),
]  # fmt: skip


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> EditingClient:
    return EditingClient(tmp_path_factory.mktemp("fuzz"))


def sent(client: EditingClient, method: str, path: str, body: object) -> tuple[int, Any]:
    """Send whatever it is; the answer must be JSON or empty."""
    content = json.dumps(body).encode() if not isinstance(body, bytes) else body
    headers = {"content-type": "application/json"}

    async def ask() -> tuple[int, bytes]:
        answer = await client.http.request(method, path, content=content, headers=headers)
        return answer.status_code, answer.content

    status, answer = asyncio.run(ask())
    assert status < 500, answer
    assert b"Traceback" not in answer
    return status, json.loads(answer) if answer else None


@settings(
    max_examples=examples(50, nightly=500), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(route=st.sampled_from(ROUTES), body=plain | st.binary(max_size=40))
def test_bodies_of_any_kind_are_refused_in_words(client: EditingClient, route: tuple[str, str], body: object) -> None:
    before = sorted(client.project.glob("behaviors/**/*"))
    status, answer = sent(client, *route, body)
    assert status in (404, 409, 422, 400)
    assert answer["message"]
    assert sorted(client.project.glob("behaviors/**/*")) == before


@settings(
    max_examples=examples(60, nightly=500), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=texts, edits=st.lists(any_edits(PATHS) | plain, max_size=3), path=st.sampled_from([*PATHS, "x", ""]))
def test_texts_and_edits_of_any_kind_are_answered(
    client: EditingClient, text: str, edits: list[Plain], path: str
) -> None:
    sent(client, "POST", f"{AT}/draft", {"text": text})
    sent(client, "POST", f"{AT}/copy", {"text": text, "paths": [path]})
    sent(client, "POST", f"{AT}/fixes", {"text": text})
    sent(client, "POST", f"{AT}/compare", {"before": SHIFT, "after": text})
    status, answer = sent(client, "POST", f"{AT}/edits", {"text": text, "edits": edits})
    if status == 200 and answer["refused"] is not None:
        assert answer["text"] == text
        assert answer["refused"]["message"]
    assert client.file.read_text() == SHIFT
