"""Transitions, parameters, fields, positions and declarations, line by line."""

from __future__ import annotations

import json

import pytest

from tests.engine.editing.edit_fixtures import changed, difference, edited, refusal
from tests.engine.editing.edits.test_node_edits import TEXT, TREE


def test_a_transition_is_set_where_it_stands() -> None:
    made = edited(TEXT, {"edit": "set_transition", "path": "root/second", "outcome": "b", "target": "third"})
    assert difference(TEXT, made) == ["-          b: bad", "+          b: third"]
    made = edited(TEXT, {"edit": "set_transition", "path": "root/third", "outcome": "late", "target": "first"})
    assert difference(TEXT, made)[1].endswith("transitions: {a: good, b: bad, c: bad, late: first}}")


def test_a_cleared_transition_goes_and_comes_back_at_the_end() -> None:
    made = edited(TEXT, {"edit": "clear_transition", "path": "root/second", "outcome": "c"})
    assert difference(TEXT, made) == ["-          c: bad"]
    again = edited(made, {"edit": "set_transition", "path": "root/second", "outcome": "c", "target": "bad"})
    assert again == TEXT
    assert "has no transition" in refusal(TEXT, {"edit": "clear_transition", "path": "root/second", "outcome": "x"})


def test_outcomes_lead_somewhere_only_in_machines() -> None:
    edit = {"edit": "set_transition", "path": "root/both/left", "outcome": "a", "target": "x"}
    assert "in a concurrency" in refusal(TEXT, edit)
    assert "in a sequence" in refusal(TREE, {**edit, "path": "root/sequence/Give"})
    assert "outermost" in refusal(TREE, {**edit, "path": "root"})


def test_the_initial_state_is_set() -> None:
    made = edited(TEXT, {"edit": "set_initial", "path": "root", "child": "third"})
    assert difference(TEXT, made) == ["-    initial: first", "+    initial: third"]
    assert "no child `x`" in refusal(TEXT, {"edit": "set_initial", "path": "root", "child": "x"})


def test_open_outcomes_are_connected_where_they_obviously_go() -> None:
    text = TEXT.replace("        transitions: {a: second, b: bad, c: third}\n", "")
    made = edited(text, {"edit": "auto_connect", "paths": ["root/first"]})
    assert "        transitions: {a: second, b: second, c: bad}\n" in made
    assert edited(made, {"edit": "auto_connect", "paths": ["root"]}) == made


def test_a_parameter_is_set_in_its_place_and_cleared_again() -> None:
    path = "root/both/left"
    made = edited(TEXT, {"edit": "set_parameter", "path": path, "name": "after_s", "value": "${pause}"})
    assert difference(TEXT, made)[1].strip("+ ") == 'left: {state: test.Give, with: {after_s: "${pause}"}}'
    made = edited(TEXT, {"edit": "set_parameter", "path": "root/both/right", "name": "after_s", "value": 3})
    assert difference(TEXT, made)[1].strip("+ ") == "right: {state: test.Give, with: {after_s: 3}}   # the other arm"
    assert edited(made, {"edit": "clear_parameter", "path": "root/both/right", "name": "after_s"}) == TEXT


def test_a_parameter_before_the_transitions() -> None:
    """Keys come where people write them."""
    made = edited(TEXT, {"edit": "set_parameter", "path": "root/second", "name": "target", "value": {"entry": "home"}})
    assert difference(TEXT, made) == ["+        with: {target: {entry: home}}"]
    assert made.index("with: {target") < made.index("a: both   # onward")


def test_an_equal_value_changes_nothing() -> None:
    assert edited(TEXT, {"edit": "set_parameter", "path": "root/first", "name": "after_s", "value": 1}) == TEXT
    assert edited(TEXT, {"edit": "set_transition", "path": "root/second", "outcome": "b", "target": "bad"}) == TEXT
    assert edited(TEXT, {"edit": "rename_node", "path": "root/second", "name": "second"}) == TEXT


@pytest.mark.parametrize(
    ("field", "value", "line"),
    [
        ("description", "Go: # there", '        description: "Go: # there"'),
        ("timeout", {"after": 3, "to": "bad"}, "        timeout: {after: 3, to: bad}"),
        ("retry", {"times": 2, "outcomes": ["b"]}, "        retry: {times: 2, outcomes: [b]}"),
        ("guard", {"when": "${x > 1}", "to": "bad"}, '        guard: {when: "${x > 1}", to: bad}'),
        ("on_error", "bad", "        on_error: bad"),
        ("autonomy", {"a": "high"}, "        autonomy: {a: high}"),
        ("resume", "ask", "        resume: ask"),
        ("in", {"value": "key"}, "        in: {value: key}"),
        ("out", {"value": "key"}, "        out: {value: key}"),
    ],
)
def test_a_field_is_set_and_taken_away_again(field: str, value: object, line: str) -> None:
    made = edited(TEXT, {"edit": "set_field", "path": "root/second", "field": field, "value": value})
    assert difference(TEXT, made) == [f"+{line}"]
    assert edited(made, {"edit": "set_field", "path": "root/second", "field": field, "value": None}) == TEXT


def test_a_field_of_another_kind_is_refused_in_words() -> None:
    edit = {"edit": "set_field", "path": "root/first", "field": "timeout", "value": {"after": "soon", "to": 3}}
    assert "`timeout.after`: not in the allowed form" in refusal(TEXT, edit)
    assert "has no `colour`" in refusal(TEXT, {**edit, "field": "colour"})
    assert "has no `memory`" in refusal(TEXT, {**edit, "field": "memory", "value": True})
    assert "nested too deeply" in refusal(TEXT, {**edit, "field": "in", "value": json.loads("[" * 60 + "]" * 60)})


def test_text_of_several_lines_is_shown_as_such() -> None:
    edit = {"edit": "set_field", "path": "root/second", "field": "description", "value": "One.\n\n  Two: 2 # two."}
    made = edited(TEXT, edit)
    assert difference(TEXT, made) == [
        "+        description: |-", "+          One.", "+", "+            Two: 2 # two."
    ]  # fmt: skip
    assert edited(made, {**edit, "value": "One."}).replace("        description: One.\n", "") == TEXT


def test_a_kind_of_state_is_changed_in_place() -> None:
    made = edited(TEXT, {"edit": "set_field", "path": "root/second", "field": "state", "value": "flow.Wait"})
    assert difference(TEXT, made) == ['-        state: "test.Give"', '+        state: "flow.Wait"']
    assert "no state" in refusal(TEXT, {"edit": "set_field", "path": "root/both", "field": "state", "value": "x"})


def test_conditions_keep_the_comments_of_those_that_stay() -> None:
    rules = [{"done": {"left": "a", "right": "a"}}, {"odd": {"right": "b"}}, {"odd": {"left": "c"}}]
    made = edited(TEXT, {"edit": "set_field", "path": "root/both", "field": "conditions", "value": rules})
    assert difference(TEXT, made) == ["-            - {odd: {left: b}}", "+            - {odd: {left: c}}"]
    assert "# all well" in made
    made = edited(TEXT, {"edit": "set_field", "path": "root/both", "field": "otherwise", "value": None})
    assert difference(TEXT, made) == ["-          otherwise: odd"]


def test_a_plain_list_of_children_gets_its_settings() -> None:
    made = edited(TREE, {"edit": "set_field", "path": "root/sequence", "field": "memory", "value": False})
    assert "    sequence:\n      memory: false\n      children:\n" in made
    assert "- state: test.Give   # give\n" in made
    assert "# The one that counts.\n" in made


def test_positions_are_set_moved_and_forgotten() -> None:
    made = edited(TEXT, {"edit": "set_positions", "positions": {"root/first": [3.14, 4], "root/third": [1, 2]}})
    assert difference(TEXT, made) == [
        "-  root/first: [0, 0]   # corner",
        "+  root/first: [3.1, 4]   # corner",
        "+  root/third: [1, 2]",
    ]
    gone = {"root/first": None, "root/both": None, "root/both/left": None}
    assert "view" not in edited(TEXT, {"edit": "set_positions", "positions": gone})
    many = {"edit": "set_positions", "positions": {"root/first": [1, 1], "root/second": [2, 2]}}
    assert edited(TREE.split("view")[0], {"edit": "set_positions", "positions": {"root": [1, 1]}}).endswith(
        "view: {root: [1, 1]}\n"
    )
    assert changed(TEXT, many) == ("root/first", "root/second")


def test_notes_are_kept_beside_the_positions_and_follow() -> None:
    made = edited(TEXT, {"edit": "set_field", "path": "root/second", "field": "notes", "value": "Mind the gap"})
    assert difference(TEXT, made) == ["+notes: {root/second: Mind the gap}"]
    made = edited(made, {"edit": "rename_node", "path": "root/second", "name": "gap"})
    assert made.endswith("notes: {root/gap: Mind the gap}\n")
    assert "notes" not in edited(made, {"edit": "set_field", "path": "root/gap", "field": "notes", "value": ""})


def test_what_the_document_declares_is_set_where_people_write_it() -> None:
    made = edited(
        TEXT,
        {
            "edit": "set_document",
            "changes": {
                "name": "day shift",
                "description": "All day.",
                "parameters": {"speed": {"type": "number", "default": 0.5, "unit": "m/s"}},
                "outcomes": ["good", "bad", "ugly"],
                "cell": "../cells/ur10.yaml",
            },
        },
    )
    assert made.startswith(
        "flexcell: 1\nname: day shift # what people call it\ndescription: All day.\ncell: ../cells/ur10.yaml\n"
        "parameters:"
    )
    assert "outcomes: [good, bad, ugly]\nsuccess: [good]\n" in made
    assert made.split("\nroot:")[1] == TEXT.split("\nroot:")[1]
    assert "no `colour`" in refusal(TEXT, {"edit": "set_document", "changes": {"colour": 1}})
    assert "`outcomes`: expected list" in refusal(TEXT, {"edit": "set_document", "changes": {"outcomes": 1}})


def test_edits_are_made_all_or_none() -> None:
    good = {"edit": "set_initial", "path": "root", "child": "third"}
    assert "no node" in refusal(TEXT, good, {"edit": "set_initial", "path": "root/x", "child": "third"})


def test_json_documents_are_edited_as_json() -> None:
    one = {"state": "test.Give", "transitions": {"a": "good"}}
    root = {"machine": {"initial": "one", "states": {"one": one}}}
    document = {"flexcell": 1, "name": "j", "outcomes": ["good"], "root": root}
    for indent in (None, 2, 4):
        text = json.dumps(document, indent=indent)
        made = edited(
            text,
            {
                "edit": "add_node",
                "parent": "root",
                "kind": "state",
                "runs": "flow.Wait",
                "parameters": {"duration_s": 1},
            },
            {"edit": "rename_node", "path": "root/one", "name": "first"},
            {"edit": "set_positions", "positions": {"root/first": [1, 2]}},
            file="x.json",
        )
        states = json.loads(made)["root"]["machine"]["states"]
        assert states["wait"] == {"state": "flow.Wait", "with": {"duration_s": 1}}
        assert json.loads(made)["view"] == {"root/first": [1, 2]}
        if indent:
            assert all(
                line in made for line in text.split("\n") if '"one"' not in line and line.strip(" ,") not in "{}[]"
            )


def test_a_node_is_disabled_before_its_transitions_and_enabled_again() -> None:
    """The page writes the outcome by which it is passed over."""
    edit = {"edit": "set_field", "path": "root/second", "field": "disabled"}
    made = edited(TEXT, {**edit, "value": "b"})
    assert difference(TEXT, made) == ["+        disabled: b"]
    for nothing in (None, False):
        assert edited(made, {**edit, "value": nothing}) == TEXT
    assert "disabled" in refusal(TEXT, {**edit, "value": 3})


def test_a_disabled_node_stays_disabled_where_it_is_moved_to() -> None:
    """An outcome leads on in a machine, the parent in a tree."""
    off = edited(TREE, {"edit": "set_field", "path": "root/sequence/Give", "field": "disabled", "value": True})
    assert "disabled: true" in off
    paste = {"edit": "paste", "parent": "root/sequence", "yaml": "off: {state: test.Give, disabled: b}\n"}
    assert edited(TREE, paste).count("disabled: true") == 1
    pasted = edited(TEXT, {"edit": "paste", "parent": "root", "yaml": "off: {state: test.Give, disabled: true}\n"})
    assert "disabled: a" in pasted
