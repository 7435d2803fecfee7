"""A changed document keeps every byte of what was not changed."""

from __future__ import annotations

import copy
import json
import random
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine.document.text.yaml_source import parse_source
from engine.editing.text.draft import Draft
from tests.engine.editing.layouts import Layout, Plain, chances, documents, scalars, trees
from tests.engine.editing.random_changes import at, leaves, mappings, mutate, set_at
from tests.tiers import examples

BEHAVIORS = Path(__file__).parents[4] / "behaviors"
FILES = sorted([*BEHAVIORS.rglob("*.yaml"), *BEHAVIORS.rglob("*.json")])


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_a_document_without_a_change_is_the_same_bytes(file: Path) -> None:
    text = file.read_bytes().decode()
    assert Draft(text, file=file.name).text() == text


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_changing_any_one_value_changes_its_line_only(file: Path) -> None:
    """One scalar in seven of every file, one after the other."""
    text = file.read_bytes().decode()
    for path in list(leaves(parse_source(text, file=file.name).data))[len(text) % 7 :: 7]:
        draft = Draft(text, file=file.name)
        set_at(draft.data, path, "changed")
        before, after = text.split("\n"), draft.text().split("\n")
        different = [n for n, (a, b) in enumerate(zip(before, after, strict=True)) if a != b]
        assert len(different) == 1, path
        assert "changed" in after[different[0]]


@settings(max_examples=examples(60, nightly=300), deadline=None)
@given(data=documents, chance=chances)
def test_any_layout_is_kept_without_a_change(data: Plain, chance: random.Random) -> None:
    text = Layout(chance).document(data)
    draft = Draft(text, file="x.yaml")
    assert draft.data == data
    assert draft.text() == text


@settings(max_examples=100, deadline=None)
@given(data=documents, chance=chances)
def test_windows_line_ends_stay(data: Plain, chance: random.Random) -> None:
    text = Layout(chance).document(data).replace("\n", "\r\n")
    assume("\r\n" in text)
    draft = Draft(text, file="x.yaml")
    assert draft.text() == text
    draft.data["added"] = {"a": [1, {"b": "two\nlines\n"}]}
    made = draft.text()
    assert made.count("\n") == made.count("\r\n")
    assert parse_source(made, file="x").data == draft.data


@settings(max_examples=examples(60, nightly=300), deadline=None)
@given(data=documents, chance=chances, changes=st.data())
def test_any_change_of_any_layout_is_written_and_nothing_else(
    data: Plain, chance: random.Random, changes: st.DataObject
) -> None:
    """Whatever is done to the data, the text then says just that; comments of what is still there are still there."""
    text = Layout(chance).document(data)
    draft = Draft(text, file="x.yaml")
    for _ in range(changes.draw(st.integers(1, 3))):
        mutate(draft.data, changes)
    expected = copy.deepcopy(draft.data)
    made = draft.text()
    assert _shown(parse_source(made, file="x.yaml").data) == _shown(expected)


@settings(max_examples=examples(60, nightly=200), deadline=None)
@given(data=documents, chance=chances, changes=st.data())
def test_a_new_value_touches_no_other_line(data: Plain, chance: random.Random, changes: st.DataObject) -> None:
    text = Layout(chance).document(data)
    found = list(leaves(data))
    assume(found)
    path = changes.draw(st.sampled_from(found))
    draft = Draft(text, file="x.yaml")
    set_at(draft.data, path, changes.draw(scalars))
    first, last = _lines_of(text, path)
    before, after = text.split("\n"), draft.text().split("\n")
    assert after[:first] == before[:first]
    tail = len(before) - last - 1
    assert after[len(after) - tail :] == before[len(before) - tail :]


@settings(max_examples=examples(60, nightly=200), deadline=None)
@given(data=documents, chance=chances, changes=st.data())
def test_adding_and_taking_away_again_gives_the_same_text(
    data: Plain, chance: random.Random, changes: st.DataObject
) -> None:
    text = Layout(chance).document(data)
    places = [path for path in mappings(data) if at(data, path)]
    path = changes.draw(st.sampled_from(places))
    draft = Draft(text, file="x.yaml")
    found = at(draft.data, path)
    items = list(found.items())
    items.insert(changes.draw(st.integers(0, len(items))), ("added", changes.draw(trees)))
    found.clear()
    found.update(items)
    again = Draft(draft.text(), file="x.yaml")
    del at(again.data, path)["added"]
    made = again.text()
    assert made == text or made.rstrip("\n") == text.rstrip("\n")


@settings(max_examples=examples(60, nightly=300), deadline=None)
@given(data=documents, chance=chances, changes=st.data())
def test_a_renamed_key_changes_its_own_line_only(data: Plain, chance: random.Random, changes: st.DataObject) -> None:
    text = Layout(chance).document(data)
    places = [path for path in mappings(data) if at(data, path)]
    path = changes.draw(st.sampled_from(places))
    draft = Draft(text, file="x.yaml")
    found = at(draft.data, path)
    key = changes.draw(st.sampled_from(list(found)))
    items = [("renamed" if each == key else each, value) for each, value in found.items()]
    found.clear()
    found.update(items)
    before, after = text.split("\n"), draft.text().split("\n")
    different = [n for n, (a, b) in enumerate(zip(before, after, strict=True)) if a != b]
    assert len(different) == 1
    back = Draft("\n".join(after), file="x.yaml")
    found = at(back.data, path)
    items = [(key if each == "renamed" else each, value) for each, value in found.items()]
    found.clear()
    found.update(items)
    assert back.text().replace('"', "").replace("'", "") == text.replace('"', "").replace("'", "")


@settings(max_examples=100, deadline=None)
@given(data=documents, chance=chances, changes=st.data())
def test_reordering_keeps_every_comment(data: Plain, chance: random.Random, changes: st.DataObject) -> None:
    text = Layout(chance).document(data)
    draft = Draft(text, file="x.yaml")
    order = changes.draw(st.permutations(list(draft.data)))
    kept = {key: draft.data[key] for key in order}
    draft.data.clear()
    draft.data.update(kept)
    made = draft.text()
    assert sorted(re.findall(r"# note \d+\.", made)) == sorted(re.findall(r"# note \d+\.", text))


@settings(max_examples=examples(60, nightly=300), deadline=None)
@given(data=documents, changes=st.data(), indent=st.sampled_from([None, 2, 4]))
def test_json_stays_json(data: Plain, changes: st.DataObject, indent: int | None) -> None:
    text = json.dumps(data, indent=indent, ensure_ascii=False)
    draft = Draft(text, file="x.json")
    assert draft.text() == text
    for _ in range(changes.draw(st.integers(1, 3))):
        mutate(draft.data, changes)
    assert json.loads(draft.text()) == draft.data


def _shown(data: object) -> str:
    return json.dumps(data)  # order and kind count


def _lines_of(text: str, path: tuple[Any, ...]) -> tuple[int, int]:
    """The first and last line of a value, by the strict reader and where the next value begins."""
    source = parse_source(text, file="x.yaml")
    start = source.position(path).line - 1
    key = source.position(path, of_key=True).line - 1
    lines = text.split("\n")
    end = start
    if re.search(r"[|>][+-]?\s*$", lines[start]):
        while end + 1 < len(lines) and (lines[end + 1].strip() == "" or lines[end + 1].startswith(" ")):
            end += 1
    return min(key, start), end
