"""Random edits of random behaviors, written in random ways, against a model of edits that knows no text."""

from __future__ import annotations

import copy
import json
import random
import re
from typing import Any, cast

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine.document import parse_behavior
from engine.document.text.yaml_source import parse_source
from engine.editing import Draft, apply_edits, copy_nodes
from engine.editing.text.outline import Outline
from tests.engine.check.random_behaviors import behaviors
from tests.engine.editing.edit_fixtures import context, edited, read_edits
from tests.engine.editing.layouts import Layout, Plain, chances
from tests.engine.editing.model import flattened, model_of
from tests.engine.editing.random_edits import MACHINES, NAMED, any_edits, simple_edits
from tests.tiers import examples


@settings(max_examples=examples(20, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances)
def test_the_nodes_of_a_text_are_those_of_the_loaded_behavior(data: Plain, chance: random.Random) -> None:
    text = Layout(chance).document(data)
    behavior = parse_behavior(text, file="x.yaml")
    refs = Outline(Draft(text, file="x.yaml").data).refs
    assert [(path, node.kind) for path, node in behavior.nodes()] == [(path, ref.kind) for path, ref in refs.items()]
    for path, ref in refs.items():
        assert behavior.source.position(ref.keys, of_key=True) == behavior.position(path)


@settings(max_examples=examples(30, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_an_edit_does_to_the_text_what_it_does_to_the_model(
    data: Plain, chance: random.Random, draw: st.DataObject
) -> None:
    """Rename, remove, wire, unwire, begin elsewhere, give parameters, describe."""
    text = Layout(chance).document(data)
    for _ in range(draw.draw(st.integers(1, 3))):
        edit = draw.draw(simple_edits(data))
        if edit is None:
            continue
        expected = model_of(data, edit)
        made = edited(text, edit)
        assert json.dumps(_read(made)) == json.dumps(expected), edit
        _check_comments(text, made, gone=edit["edit"] in ("remove_nodes", "clear_transition"))
        text, data = made, expected


@settings(max_examples=examples(25, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_a_rename_and_its_inverse_give_the_same_text(data: Plain, chance: random.Random, draw: st.DataObject) -> None:
    text = Layout(chance).document(data)
    refs = [s for s in Outline(data).refs.values() if s.parent is not None and s.parent.kind in NAMED]
    ref = draw.draw(st.sampled_from(refs))
    there = edited(text, {"edit": "rename_node", "path": ref.path, "name": "fresh"})
    parent = ref.path.rpartition("/")[0]
    back = edited(there, {"edit": "rename_node", "path": f"{parent}/fresh", "name": ref.name})
    assert _unquoted(back) == _unquoted(text)


@settings(max_examples=examples(25, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_grouping_as_a_machine_means_the_same_and_ungrouping_takes_it_back(
    data: Plain, chance: random.Random, draw: st.DataObject
) -> None:
    text = Layout(chance).document(data)
    outline = Outline(data)
    machine = draw.draw(st.sampled_from([ref for ref in outline.refs.values() if ref.kind in MACHINES]))
    children = [child.path for child in outline.children(machine)]
    size = draw.draw(st.integers(1, len(children)))
    start = draw.draw(st.integers(0, len(children) - size))
    edits, _ = read_edits(
        [{"edit": "group", "paths": children[start : start + size], "kind": "machine", "name": "inner"}]
    )
    done = apply_edits(text, edits, file="x.yaml", context=context())
    if done.refused is not None:
        assert "entered from outside" in done.refused.message
        return
    assert flattened(_read(done.text), machine.path) == flattened(data, machine.path)
    _check_comments(text, done.text, gone=False)
    back = edited(done.text, {"edit": "ungroup", "path": f"{machine.path}/inner"})
    assert json.dumps(_read(back)) == json.dumps(data)
    _check_comments(text, back, gone=False)


@settings(max_examples=examples(25, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_adding_a_node_and_removing_it_gives_the_same_text(
    data: Plain, chance: random.Random, draw: st.DataObject
) -> None:
    text = Layout(chance).document(data)
    containers = [ref for ref in Outline(data).refs.values() if ref.kind in (*NAMED, "sequence")]
    path = draw.draw(st.sampled_from(containers)).path
    index = draw.draw(st.integers(0, 4))
    add = {"edit": "add_node", "parent": path, "kind": "state", "runs": "data.Choose", "name": "fresh", "index": index}
    back = edited(edited(text, add), {"edit": "remove_nodes", "paths": [f"{path}/fresh"]})
    assert back.rstrip("\n") == text.rstrip("\n")


@settings(max_examples=examples(40, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_whatever_is_asked_is_done_whole_or_refused_in_words(
    data: Plain, chance: random.Random, draw: st.DataObject
) -> None:
    """Also nonsense; the result can always be read, checked and drawn."""
    text = Layout(chance).document(data)
    for _ in range(4):
        raw = draw.draw(any_edits(list(Outline(Draft(text, file="x.yaml").data).refs)))
        edits, refusal = read_edits([raw])
        if refusal is not None:
            assert refusal
            continue
        done = apply_edits(text, edits, file="x.yaml", context=context())
        if done.refused is not None:
            assert done.refused.message
            assert "layout" not in done.refused.message
            assert done.text == text
        text = done.text
    Outline(Draft(text, file="x.yaml").data)


@settings(max_examples=examples(20, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_what_is_copied_and_pasted_is_the_same(data: Plain, chance: random.Random, draw: st.DataObject) -> None:
    """In another behavior only the transitions stay that lead to something there."""
    text = Layout(chance).document(data)
    refs = [s for s in Outline(data).refs.values() if s.parent is not None and s.parent.kind in MACHINES]
    ref = draw.draw(st.sampled_from(refs))
    yaml = copy_nodes(text, [ref.path], file="x.yaml", context=context())
    assert _read(yaml) == {ref.name: ref.data}
    target = "flexcell: 1\nname: t\noutcomes: [x, y]\nroot:\n  machine:\n    states: {}\n"
    made = _read(edited(target, {"edit": "paste", "parent": "root", "yaml": yaml}))
    ((name, pasted),) = made["root"]["machine"]["states"].items()
    expected = copy.deepcopy(cast("Plain", ref.data))
    wired = {how: to for how, to in expected.pop("transitions", {}).items() if to in ("x", "y", ref.name)}
    assert pasted.pop("transitions", {}) == {how: name if to == ref.name else to for how, to in wired.items()}
    assume("timeout" not in expected)  # what it leads to may be called otherwise now
    assert pasted == expected


def _read(text: str) -> Any:
    return parse_source(text, file="x.yaml").data


def _check_comments(before: str, after: str, *, gone: bool) -> None:
    """No comment is lost, but for those of what has gone; none comes twice."""
    old, new = re.findall(r"# note \d+\.", before), re.findall(r"# note \d+\.", after)
    assert len(set(new)) == len(new)
    assert set(new) <= set(old)
    if not gone:
        assert set(new) == set(old)


def _unquoted(text: str) -> str:
    return text.replace('"', "").replace("'", "")
