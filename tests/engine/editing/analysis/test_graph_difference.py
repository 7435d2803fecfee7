"""What a page gets after an edit: the difference of the graphs, and findings, both as if made from scratch."""

from __future__ import annotations

import json
import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from benchmarks.edits import edits_of, subjects
from engine.editing import Draft, analyze_text
from engine.editing.analysis.graph_difference import GraphDifference, shifted
from engine.editing.draft_cache import DraftCache
from engine.editing.text.outline import Outline
from tests.engine.check.random_behaviors import behaviors
from tests.engine.editing.edit_fixtures import analysis_of, context, read_edits
from tests.engine.editing.layouts import Layout, Plain, chances
from tests.engine.editing.optimistic_examples import EXAMPLES, encoded
from tests.engine.editing.random_edits import any_edits

FILE = Path("no-such-project/x.yaml")


def applied(graph: dict[str, Any], difference: GraphDifference) -> dict[str, Any]:
    """The new graph: what the page does with the old one."""
    said = json.loads(msgspec.json.encode(difference))
    begins: list[int] = [begin for begin, _ in said["shifts"]]
    moves: list[int] = [by for _, by in said["shifts"]]
    old: dict[str, dict[str, Any]] = {}

    def collect(node: dict[str, Any]) -> None:
        old[node["path"]] = node
        for child in node["children"]:
            collect(child)

    def made(path: str) -> dict[str, Any]:
        was: dict[str, Any] = old.get(path, {"children": [], "transitions": []})
        own: dict[str, Any] = {**was, **said["nodes"].get(path, {})}
        before: list[str] = [child["name"] for child in was["children"]]
        names: list[str] = said["children"].get(path, before)
        lines = said["lines"].get(path) or shifted((was["line"], was["column"], was["end_line"]), begins, moves)
        arrows: dict[str, list[Any]] = {}
        for arrow in was["transitions"]:
            arrows.setdefault(arrow["source"], []).append(arrow)
        arrows |= said["arrows"].get(path, {})
        own["transitions"] = [arrow for name in names for arrow in arrows.get(name, [])]
        own["children"] = [made(f"{path}/{name}") for name in names]
        own |= dict(zip(("line", "column", "end_line"), lines, strict=True))
        return own

    collect(graph)
    return made("root")


def _plain(value: object) -> Any:
    return json.loads(msgspec.json.encode(value))


@settings(max_examples=80, deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_any_edit_is_answered_with_what_a_look_from_scratch_says(
    data: Plain, chance: random.Random, draw: st.DataObject
) -> None:
    """The difference applied to the old graph is the new graph, and the findings are those of the text alone."""
    text = Layout(chance).document(data)
    drafts, known = DraftCache(), context(FILE.parent)
    drawn = drafts.draw(text, file=FILE, context=known)
    graph, base = _plain(drawn.graph), drawn.hash
    for _ in range(3):
        edits, problem = read_edits([draw.draw(any_edits(list(Outline(Draft(text, file="x.yaml").data).refs)))])
        assume(problem is None)
        answer = drafts.edit(text, edits, file=FILE, context=known, check=True, graph=base)
        expected = analyze_text(answer.text, file=FILE, context=known)
        if answer.refused is not None:
            assert analysis_of(answer) == expected
        else:
            assert answer.difference is not None
            assert analysis_of(answer) == replace(expected, graph=None)
            assert answer.difference.base == base
            graph = applied(graph, answer.difference)
            assert graph == _plain(expected.graph)
        text, base = answer.text, answer.hash


@pytest.mark.parametrize("subject", subjects(60), ids=lambda each: each.name)
def test_edits_one_after_the_other_send_little(subject: Any) -> None:
    drafts, known, text = DraftCache(), context(FILE.parent), subject.text
    place = subject.place if subject.name == "flat" else "root/area_0/step_0"
    nodes = ("s20", "s21") if subject.name == "flat" else subject.nodes
    drawn = drafts.draw(text, file=FILE, context=known)
    graph, base = _plain(drawn.graph), drawn.hash
    for name, make in edits_of(replace(subject, place=place, nodes=nodes)).items():
        for number in range(2):
            edits, _ = read_edits([make(number)])
            answer = drafts.edit(text, edits, file=FILE, context=known, check=True, graph=base)
            assert answer.refused is None, (name, answer.refused)
            expected = analyze_text(answer.text, file=FILE, context=known)
            assert analysis_of(answer) == replace(expected, graph=None)
            assert answer.difference is not None
            assert len(answer.difference.nodes) <= 2
            graph = applied(graph, answer.difference)
            assert graph == _plain(expected.graph)
            text, base = answer.text, answer.hash


def test_a_graph_that_the_server_does_not_know_is_answered_whole() -> None:
    text = subjects(20)[0].text
    drafts, known = DraftCache(), context(FILE.parent)
    edits, _ = read_edits([{"edit": "rename_node", "path": "root/s3", "name": "other"}])
    first = drafts.edit(text, edits, file=FILE, context=known, graph=None)
    assert (first.difference, first.graph is None) == (None, False)
    drafts.draw(text, file=FILE, context=known)
    assert drafts.edit(text, edits, file=FILE, context=known, graph="0" * 64).difference is None


def test_the_examples_of_the_page_are_what_the_server_answers() -> None:
    assert EXAMPLES.read_bytes() == encoded(), "run `python -m tests.engine.editing.optimistic_examples`"
