"""Giving nodes another type in place: what fits is kept, and nothing is lost that was not shown."""

from __future__ import annotations

import copy
import json
import random
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.document.text.yaml_source import parse_source
from engine.editing import apply_edits
from engine.editing.edits.apply import EditResult
from engine.editing.edits.edit import ReplaceType, TypeLoss
from engine.editing.text.outline import Outline
from tests.engine.check.random_behaviors import behaviors
from tests.engine.editing.edit_fixtures import changed, context, difference, edited, refusal
from tests.engine.editing.edits.test_node_edits import TEXT, TREE
from tests.engine.editing.layouts import Layout, Plain, chances
from tests.tiers import examples

NOTED = (
    TEXT.replace("        timeout: {", "        autonomy: {a: high, c: low}   # agreed\n        timeout: {")
    + "notes: {root/first: mind the cable}\n"
)


def replacement(text: str, *paths: str, kind: str, runs: str = "", folder: Path = Path("none")) -> EditResult:
    """The answer to an edit that accepts no loss."""
    edit = ReplaceType(paths=paths, kind=kind, runs=runs)
    return apply_edits(text, [edit], file=str(folder / "x.yaml"), context=context(folder))


def accepted(text: str, *paths: str, kind: str, runs: str = "") -> tuple[str, tuple[TypeLoss, ...]]:
    """The text after an edit that accepts what it loses, and what that is."""
    refused = replacement(text, *paths, kind=kind, runs=runs).refused
    losses = refused.losses if refused is not None else ()
    edit = ReplaceType(paths=paths, kind=kind, runs=runs, accepted=losses)
    done = apply_edits(text, [edit], file="x.yaml", context=context())
    assert done.refused is None, done.refused
    return done.text, losses


def items(losses: tuple[TypeLoss, ...]) -> list[str]:
    """Each loss in one line."""
    return [f"{loss.path} {loss.item}: {loss.value}" for loss in losses]


def test_what_fits_another_state_is_kept_and_what_does_not_is_shown_before() -> None:
    refused = replacement(NOTED, "root/first", kind="state", runs="data.Choose").refused
    assert refused is not None
    assert refused.message == "the new type does not keep the parameter `after_s` of `root/first` and 2 more"
    assert items(refused.losses) == [
        "root/first parameter `after_s`: 1",
        'root/first transition `c`: "third"',
        'root/first autonomy `c`: "low"',
    ]
    assert refused.losses[0].reason == "`data.Choose` has no parameter `after_s`"
    made, _ = accepted(NOTED, "root/first", kind="state", runs="data.Choose")
    assert difference(NOTED, made) == [
        "-        state: test.Give",
        "-        with: {after_s: 1}",
        "-        transitions: {a: second, b: bad, c: third}",
        "-        autonomy: {a: high, c: low}   # agreed",
        "+        state: data.Choose",
        "+        transitions: {a: second, b: bad}",
        "+        autonomy: {a: high}   # agreed",
    ]


def test_a_loss_that_was_not_shown_is_not_accepted() -> None:
    refused = replacement(NOTED, "root/first", kind="state", runs="data.Choose").refused
    assert refused is not None
    for left in range(len(refused.losses)):
        some = refused.losses[:left] + refused.losses[left + 1 :]
        edit = {"paths": ["root/first"], "kind": "state", "runs": "data.Choose", "accepted": msgspec.to_builtins(some)}
        assert "does not keep" in refusal(NOTED, {"edit": "replace_type", **edit})
    other = NOTED.replace("{after_s: 1}", "{after_s: 2}")
    edit = ReplaceType(paths=("root/first",), kind="state", runs="data.Choose", accepted=refused.losses)
    assert apply_edits(other, [edit], file="x.yaml", context=context()).refused is not None


def test_a_parameter_of_the_same_name_is_kept_only_with_a_fitting_value() -> None:
    text = TEXT.replace("with: {after_s: 1}", "with: {value: 7, text: hi}")
    _, losses = accepted(text.replace("test.Give", "data.Put", 1), "root/first", kind="state", runs="data.Text")
    assert [loss.item for loss in losses if "parameter" in loss.item] == ["parameter `value`"]
    wrong = text.replace("text: hi", "text: 5")
    _, losses = accepted(wrong, "root/first", kind="state", runs="data.Text")
    assert [(loss.item, loss.reason) for loss in losses][1] == ("parameter `text`", "expected text, got integer")
    later = text.replace("text: hi", 'text: "${k}"')
    _, losses = accepted(later, "root/first", kind="state", runs="data.Text")
    assert "parameter `text`" not in [loss.item for loss in losses]


def test_several_nodes_are_replaced_by_one_edit() -> None:
    made, losses = accepted(TEXT, "root/first", "root/third", kind="state", runs="data.Choose")
    assert {loss.path for loss in losses} == {"root/first", "root/third"}
    assert made.count("data.Choose") == 2
    edit = {"edit": "replace_type", "paths": ["root/both", "root/first"], "kind": "priority", "accepted": []}
    assert "does not keep" in refusal(TEXT, edit)


def test_a_behavior_takes_the_place_of_a_state_with_the_parameters_that_it_declares(tmp_path: Path) -> None:
    head = "flexcell: 1\nname: inner\noutcomes: [a, none]\nsuccess: [a]\nparameters:\n"
    root = "root: {machine: {initial: one, states: {one: {state: test.Give, transitions: {a: a, b: none, c: none}}}}}\n"
    (tmp_path / "inner.yaml").write_text(f"{head}  after_s: {{type: number, maximum: 5}}\n{root}")
    done = replacement(TEXT, "root/first", kind="behavior", runs="inner.yaml", folder=tmp_path)
    assert done.refused is not None
    assert items(done.refused.losses) == ['root/first transition `b`: "bad"', 'root/first transition `c`: "third"']
    high = TEXT.replace("after_s: 1", "after_s: 9")
    done = replacement(high, "root/first", kind="behavior", runs="inner.yaml", folder=tmp_path)
    assert done.refused is not None
    assert done.refused.losses[0].reason == "9 is above the maximum 5"
    gone = replacement(TEXT, "root/first", kind="behavior", runs="gone.yaml", folder=tmp_path).refused
    assert gone is not None
    assert "there is no behavior `gone.yaml`" in gone.message


def test_a_container_keeps_its_nodes_where_the_other_kind_can_hold_them() -> None:
    edit = {"edit": "replace_type", "paths": ["root"], "kind": "priority"}
    assert difference(TEXT, edited(TEXT, edit)) == ["-  machine:", "+  priority:"]
    made, losses = accepted(TEXT, "root/both", kind="machine")
    assert [loss.item for loss in losses] == ["field `conditions`", "field `otherwise`"]
    assert "initial: left\n" in made
    assert "right: {state: test.Give}   # the other arm\n" in made
    assert "transitions: {done: third, odd: bad}\n" in made
    noted = TEXT.replace("        concurrency:\n", "        concurrency:   # at once\n")
    assert "        machine:   # at once\n" in accepted(noted, "root/both", kind="machine")[0]
    made, losses = accepted(TEXT, "root/both", kind="tree")
    assert "- {name: right, state: test.Give}   # the other arm\n" in made
    assert "root/both/sequence/left: [10, 20]" in made
    made, losses = accepted(TEXT, "root/both", kind="state", runs="test.Give")
    assert [loss.path for loss in losses if loss.item == "node"] == ["root/both/left", "root/both/right"]


def test_parts_of_a_tree_are_replaced_and_what_names_them_follows() -> None:
    edit = {"edit": "replace_type", "paths": ["root/sequence"], "kind": "selector"}
    assert difference(TREE, edited(TREE, edit)) == [
        "-    sequence:",
        "+    selector:",
        "-view: {root/sequence/Give_2: [1, 2]}",
        "+view: {root/selector/Give_2: [1, 2]}",
    ]
    made, losses = accepted(TREE, "root/sequence/parallel", kind="if_then_else")
    assert items(losses) == ['root/sequence/parallel field `policy`: ["Give_2"]']
    assert "          # The one that counts.\n          then:\n" in made
    _, losses = accepted(TREE, "root/sequence", kind="inverter")
    assert items(losses) == ["root/sequence/Give_2 node: ", "root/sequence/parallel node: 2 nodes inside"]
    assert changed(TREE, {"edit": "replace_type", "paths": ["root/sequence/Give"], "kind": "retry"}) == (
        "root/sequence/retry",
    )


@pytest.mark.parametrize(
    ("path", "kind", "runs", "why"),
    [
        ("root/first", "state", "test.Giv", "there is no state `test.Giv`"),
        ("root/first", "zzz", "", "there is no kind `zzz`"),
        ("root/first", "inverter", "", "valid only inside a tree"),
        ("root/gone", "machine", "", "there is no node `root/gone`"),
    ],
)
def test_what_cannot_be_is_refused(path: str, kind: str, runs: str, why: str) -> None:
    assert why in refusal(TEXT, {"edit": "replace_type", "paths": [path], "kind": kind, "runs": runs})


def test_a_disabled_node_stays_disabled() -> None:
    text = TEXT.replace("      third: {state: test.Give,", "      third: {state: test.Give, disabled: c,")
    made, losses = accepted(text, "root/third", kind="state", runs="data.Choose")
    assert "disabled: a" in made
    assert 'root/third field `disabled`: "c"' in items(losses)


def test_outcomes_of_a_retry_that_are_lost_are_shown_by_name() -> None:
    text = TEXT.replace(
        "      third: {state: test.Give,", "      third: {state: test.Give, retry: {times: 1, outcomes: [c]},"
    )
    assert text != TEXT
    _, losses = accepted(text, "root/third", kind="state", runs="data.Put")
    assert 'root/third retry `outcomes`: ["c"]' in items(losses)


KINDS = st.sampled_from(
    [("state", "data.Put"), ("state", "data.Choose"), ("machine", ""), ("priority", ""), ("concurrency", ""),
     ("tree", ""), ("foreach", ""), ("sequence", ""), ("parallel", ""), ("inverter", ""), ("if_then_else", "")]
)  # fmt: skip


@settings(max_examples=examples(30, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_everything_of_any_behavior_is_kept_or_shown(data: Plain, chance: random.Random, draw: st.DataObject) -> None:
    """Counted on the plain data, without what the edit knows of nodes."""
    text = Layout(chance).document(data)
    path = draw.draw(st.sampled_from(list(Outline(data).refs)))
    kind, runs = draw.draw(KINDS)
    refused = replacement(text, path, kind=kind, runs=runs).refused
    if refused is not None and not refused.losses:
        return
    made, losses = accepted(text, path, kind=kind, runs=runs)
    after: Any = parse_source(made, file="x.yaml").data
    shown = _shown(data, losses)
    ref = Outline(copy.deepcopy(data)).at(path)
    shown[str(ref.data.get("state"))] += 1  # what it ran, which is what was replaced
    shown[str(ref.data.get("behavior"))] += 1
    missing = Counter(_leaves(data["root"])) - Counter(_leaves(after["root"]))
    assert missing - shown == Counter(), losses


@settings(max_examples=examples(20, nightly=300), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_a_kind_of_the_same_form_is_taken_back_without_a_changed_byte(
    data: Plain, chance: random.Random, draw: st.DataObject
) -> None:
    text = Layout(chance).document(data)
    pairs = {"machine": "priority", "priority": "machine"}
    refs = [ref for ref in Outline(data).refs.values() if ref.kind in pairs and not ref.in_tree]
    ref = draw.draw(st.sampled_from(refs))
    edit = {"edit": "replace_type", "paths": [ref.path]}
    there = edited(text, {**edit, "kind": pairs[ref.kind]})
    assert there != text
    assert edited(there, {**edit, "kind": ref.kind}).replace('"', "").replace("'", "") == text.replace('"', "").replace(
        "'", ""
    )


def _leaves(value: object) -> Iterator[str]:
    if isinstance(value, dict):
        for each in cast("Plain", value).values():
            yield from _leaves(each)
    elif isinstance(value, list):
        for each in cast("list[object]", value):
            yield from _leaves(each)
    else:
        yield str(value)


def _shown(data: Plain, losses: tuple[TypeLoss, ...]) -> Counter[str]:
    """The values that the losses name; of a node, all that is in it."""
    refs = Outline(copy.deepcopy(data)).refs
    found: Counter[str] = Counter()
    for loss in losses:
        found.update(_leaves(refs[loss.path].data if loss.item == "node" else json.loads(loss.value)))
    return found
