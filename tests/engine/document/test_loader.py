"""Behavior documents: models, meaning, references, and errors with positions."""

from __future__ import annotations

import json
import time
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.document import Behavior, load_behavior, parse_behavior, read_behavior, write_yaml
from engine.errors import DocumentError, Position
from tests.engine.document.example_documents import BEHAVIORS, Plain
from tests.tiers import examples

GOOD = """flexcell: 1
name: transfer
parameters: {speed: {type: number, default: 1}}
outcomes: [done, failed]
success: [done]
root:
  machine:
    initial: go
    states:
      go:
        concurrency:
          states:
            left: {state: a.B, with: {x: 1}, timeout: {after: 30 s, to: late}}
          conditions:
            - {done: {left: ok}}
        transitions: {done: done}
        retry: {times: 2, backoff: 500 ms}
view: {root/go: [1, 2]}
"""

LEFT = "left: {state: a.B, with: {x: 1}, timeout: {after: 30 s, to: late}}"

WRONG: dict[str, tuple[str, str, str, str]] = {
    "unknown duration": ("30 s", "30 sek", "30 sek", "`after`: not in the allowed form"),
    "negative duration": ("30 s", "-3", "-3", "expected number >= 0"),
    "no repetition": ("times: 2", "times: 0", "0", "expected integer >= 1"),
    "mistyped key": ("times: 2", "tmes: 2", "tmes", "unknown key `tmes`"),
    "no kind": ("state: a.B, ", "", "left:", "this node has no kind"),
    "two kinds": ("state: a.B", "state: a.B, behavior: b.yaml", "behavior", "several kinds: `state`, `behavior`"),
    "slash in a name": ("left: {state", "le/ft: {state", "le/ft", "`le/ft`: not in the allowed form"),
    "two outcomes in a condition": (
        "done: {left: ok}",
        "done: {left: ok}, failed: {left: ko}",
        "failed: {left: ko}",
        "a condition has one outcome",
    ),
    "three keys in a condition": ("ok}}", "ok}, a: {left: ok}, b: {left: ok}}", "{done", "length <= 2"),
    "an outcome and whom to preempt": (
        "{done: {left: ok}}",
        "{preempt: [left], done: {left: ok}}",
        "done: {left: ok}}",
        "a condition decides an outcome or has `preempt`, not both",
    ),
    "preempt without when": (
        "{done: {left: ok}}",
        "{preempt: [left]}",
        "preempt",
        "a condition with `preempt` requires `when`",
    ),
    "preempt without names": (
        "{done: {left: ok}}",
        "{preempt: [], when: {left: ok}}",
        "[]",
        "expected list of length >= 1",
    ),
    "preempted twice": ("done: {left: ok}", "preempt: [a, a], when: {left: ok}", "preempt", "`a` is repeated"),
    "a count beyond the children of when": (
        "{done: {left: ok}}",
        "{preempt: [a], when: {left: ok, at_least: 2}}",
        "2}",
        "there are only 1 children",
    ),
    "a list in place of a mapping": (
        "{done: {left: ok}}",
        "{done: [left]}",
        "done",
        "`done`: expected a mapping, got a list",
    ),
    "number as outcome": ("ok}", "1}", "1}", "only `at_least` is a number"),
    "number that is no count": ("ok}", "ok, right: 2}", "2}", "only `at_least` is a number"),
    "count without children": ("{left: ok}", "{at_least: 1}", "1}", "there are only 0 children in this condition"),
    "count beyond the children": ("left: ok}", "left: ok, at_least: 2}", "2}", "there are only 1 children"),
    "no count": ("left: ok}", "left: ok, at_least: 0}", "0}", "expected integer >= 1"),
    "unknown parameter type": ("type: number", "type: float", "float", "there is no choice 'float'"),
    "reserved parameter name": ("speed:", "in:", "in:", "`in` is a reserved word of the expression language"),
    "parameter and userdata": ("root:", "userdata: {speed: 1}\nroot:", "speed: 1}", "a parameter and a userdata key"),
    "a success outside a tree": (
        "retry: {times",
        "success: [done]\n        retry: {times",
        "success: [done]",
        "`success` of a node is only allowed inside a tree",
    ),
    "a guard without target": (
        "retry: {times",
        "guard: {when: '${true}'}\n        retry: {times",
        "{when",
        "the key `to` is missing",
    ),
    "an unknown level of autonomy": (
        "retry: {times",
        "autonomy: {done: medium}\n        retry: {times",
        "medium",
        "there is no choice 'medium'",
    ),
    "inputs of a container": ("retry: {times", "in: {a: b}\n        retry: {times", "in: {a", "has no `in`"),
    "transitions side by side": ("with: {x: 1}", "transitions: {ok: left}", "transitions", "has no transitions"),
    "transitions of the root": ("root:\n", "root:\n  transitions: {done: done}\n", "transitions", "the root has no"),
    "empty container": (
        "left: {state: a.B, with: {x: 1}, timeout: {after: 30 s, to: late}}",
        "{}",
        "{}",
        "length >= 1",
    ),
    "no outcomes": ("outcomes: [done, failed]", "outcomes: []", "[]", "length >= 1"),
    "outcome twice": ("outcomes: [done, failed]", "outcomes: [done, done]", "done]", "`done` is repeated"),
    "future version": ("flexcell: 1", "flexcell: 2", "2", "there is no choice 2"),
    "no version": ("flexcell: 1\n", "", "name", "`flexcell` is missing"),
    "missing reference": ("state: a.B", "behavior: none.yaml", "none.yaml", "no behavior file `none.yaml`"),
    "bad position in view": ("[1, 2]", "[1]", "[1]", "expected list of length 2"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_document_is_refused_where_the_mistake_stands(name: str) -> None:
    """One line with file, line and column of the offending text."""
    old, new, at, says = WRONG[name]
    assert old in GOOD
    text = GOOD.replace(old, new, 1)
    with pytest.raises(DocumentError) as refusal:
        parse_behavior(text, file="x.yaml")
    assert says in str(refusal.value)
    where = refusal.value.where
    assert isinstance(where, Position)
    assert text.splitlines()[where.line - 1][where.column - 1 :].startswith(at)


@pytest.mark.parametrize("text", ["[]", "3", "null", "a", '"x"'])
def test_a_document_that_is_no_mapping_is_refused(text: str) -> None:
    """Lists and scalars are no behaviors."""
    with pytest.raises(DocumentError, match=r"x\.yaml:1:1: expected mapping"):
        parse_behavior(text, file="x.yaml")


def test_the_one_wrong_node_among_many_is_found() -> None:
    """The position is that of the wrong sibling, at every level."""
    good = "s{0}: {{concurrency: {{states: {{a: {{state: x}}, b: {{state: x}}}}, conditions: []}}}}"
    nodes = [good.format(i) for i in range(5)]
    nodes[3] = nodes[3].replace("b: {state: x}", "b: {state: x, transitions: {y: 1}}")
    lines = "".join(f"      {node}\n" for node in nodes)
    text = f"flexcell: 1\nname: x\noutcomes: [ok]\nroot:\n  machine:\n    initial: s0\n    states:\n{lines}"
    with pytest.raises(DocumentError, match=r"x\.yaml:11:81: `y`: expected text, got integer"):
        parse_behavior(text, file="x.yaml")


def test_nodes_come_in_document_order_with_paths_and_positions() -> None:
    """The order of the document is the order of precedence."""
    behavior = parse_behavior(GOOD, file="x.yaml")
    assert [(path, node.kind) for path, node in behavior.nodes()] == [
        ("root", "machine"),
        ("root/go", "concurrency"),
        ("root/go/left", "state"),
    ]
    places = [
        behavior.position("root/go/left"),
        behavior.position("root/go/left", "with", "x"),
        behavior.key_position("root/go/left", "timeout"),
        behavior.position("root/go/nothing/inside"),
    ]
    assert [(p.line, p.column) for p in places] == [(13, 13), (13, 42), (13, 46), (10, 7)]


def test_durations_are_seconds() -> None:
    """Timeout and backoff are read once, in seconds."""
    node = parse_behavior(GOOD, file="x.yaml").root.children["go"]
    left = node.children["left"]
    assert left.timeout is not None
    assert node.retry is not None
    assert (left.timeout.after_s, node.retry.backoff_s) == (30.0, 0.5)


@given(BEHAVIORS)
@settings(max_examples=examples(30, nightly=300))
def test_a_document_written_and_read_again_means_the_same(document: Plain) -> None:
    """As YAML, as JSON and from the models themselves."""
    behavior = parse_behavior(json.dumps(document), file="x.json")
    again = parse_behavior(write_yaml(document), file="x.yaml")
    from_models = parse_behavior(msgspec.json.encode(behavior.document), file="x.json")
    assert again.document == behavior.document == from_models.document
    assert again.meaning == behavior.meaning == from_models.meaning


@given(
    BEHAVIORS, st.dictionaries(st.sampled_from(["root", "root/go", "x"]), st.tuples(st.floats(0, 9), st.floats(0, 9)))
)
def test_moving_boxes_never_changes_the_meaning(document: Plain, view: dict[str, tuple[float, float]]) -> None:
    """Canvas positions and comments are no part of the hash."""
    plain = {key: value for key, value in document.items() if key != "view"}
    moved = write_yaml({**plain, "view": {path: list(place) for path, place in view.items()}}) + "# a comment\n"
    assert parse_behavior(moved, file="y.yaml").meaning == parse_behavior(write_yaml(plain), file="x.yaml").meaning


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("x: 1", "x: 2"),
        ("to: late", "to: later"),
        ("times: 2", "times: 3"),
        ("done: done", "done: failed"),
        ("default: 1", "default: 2"),
        ("success: [done]", "success: []"),
        ("left: {state", "west: {state"),
    ],
)
def test_every_change_of_meaning_changes_the_hash(old: str, new: str) -> None:
    """A value, a target, a default, a name."""
    changed = parse_behavior(GOOD.replace(old, new), file="x.yaml")
    assert changed.meaning != parse_behavior(GOOD, file="x.yaml").meaning


def test_the_order_of_nodes_is_meaning_and_that_of_other_keys_is_not() -> None:
    """Siblings decide in document order."""
    head = "flexcell: 1\nname: x\noutcomes: [done]\nroot: {machine: {initial: a, states: "
    texts = [
        "{a: {state: s, with: {p: 1, q: 2}}, b: {state: t}}}}",
        "{b: {state: t}, a: {state: s, with: {p: 1, q: 2}}}}}",
        "{a: {with: {q: 2, p: 1}, state: s}, b: {state: t}}}}",
    ]
    first, exchanged, reordered = (parse_behavior(head + text, file="x.yaml").meaning for text in texts)
    assert first == reordered
    assert first != exchanged


def reference(name: str) -> str:
    """Return a behavior that refers to the file `name`."""
    return f"flexcell: 1\nname: x\noutcomes: [done]\nroot: {{behavior: {name}}}\n"


LEAF = "flexcell: 1\nname: leaf\noutcomes: [done]\nroot: {state: a.B}\n"


def test_references_are_relative_to_their_document_and_each_file_is_read_once(tmp_path: Path) -> None:
    """Two uses of a file, by different paths, share one behavior."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "leaf.yaml").write_text(LEAF)
    (tmp_path / "parts" / "inner.yaml").write_text(reference("leaf.yaml"))
    top = (
        "flexcell: 1\nname: x\noutcomes: [done]\nroot: {machine: {initial: a, states: "
        "{a: {behavior: parts/inner.yaml}, b: {behavior: parts/../parts/leaf.yaml}}}}\n"
    )
    (tmp_path / "top.yaml").write_text(top)
    behavior = load_behavior(tmp_path / "top.yaml")
    inner = behavior.references["parts/inner.yaml"]
    assert inner.references["leaf.yaml"] is behavior.references["parts/../parts/leaf.yaml"]


def test_the_meaning_includes_that_of_references(tmp_path: Path) -> None:
    """A change in a referenced file is a change of the behavior."""
    (tmp_path / "top.yaml").write_text(reference("leaf.yaml"))
    meanings: list[str] = []
    for leaf in (LEAF, LEAF + "# comment\n", LEAF.replace("a.B", "a.C")):
        (tmp_path / "leaf.yaml").write_text(leaf)
        meanings.append(load_behavior(tmp_path / "top.yaml").meaning)
    assert meanings[0] == meanings[1] != meanings[2]


def test_a_circle_is_refused_with_its_chain(tmp_path: Path) -> None:
    """The error stands at the reference that closes the circle."""
    for name, following in (("a", "b"), ("b", "c"), ("c", "b")):
        (tmp_path / f"{name}.yaml").write_text(reference(f"{following}.yaml"))
    with pytest.raises(DocumentError, match=r"c\.yaml:4:18: circular behavior reference: b\.yaml → c\.yaml → b\.yaml"):
        load_behavior(tmp_path / "a.yaml")
    behavior, circles = read_behavior(tmp_path / "a.yaml")
    assert isinstance(behavior, Behavior)
    assert [str(circle) for circle in circles] == ["b.yaml → c.yaml → b.yaml"]


def test_a_behavior_that_contains_itself_is_refused_before_it_is_saved(tmp_path: Path) -> None:
    """The editor parses text for a file that may not exist yet."""
    (tmp_path / "other.yaml").write_text(reference("new.yaml"))
    with pytest.raises(DocumentError, match=r"circular behavior reference: new\.yaml → other\.yaml → new\.yaml"):
        parse_behavior(reference("other.yaml"), file=tmp_path / "new.yaml")


def test_a_mistake_in_a_referenced_file_is_reported_in_that_file(tmp_path: Path) -> None:
    """The position is that of the file with the mistake."""
    (tmp_path / "top.yaml").write_text(reference("leaf.yaml"))
    (tmp_path / "leaf.yaml").write_text(LEAF.replace("state:", "stat:"))
    with pytest.raises(DocumentError, match=r"leaf\.yaml:4:8: unknown key `stat`"):
        load_behavior(tmp_path / "top.yaml")


def test_references_that_multiply_without_end_are_refused(tmp_path: Path) -> None:
    """Each file uses the next one twice: 2^30 nodes unfolded, refused while reading."""
    for i in range(30):
        use = f"{{behavior: f{i + 1}.yaml}}"
        root = f"{{machine: {{initial: a, states: {{a: {use}, b: {use}}}}}}}"
        text = f"flexcell: 1\nname: x\noutcomes: [done]\nroot: {root}\n"
        (tmp_path / f"f{i}.yaml").write_text(text)
    (tmp_path / "f30.yaml").write_text(LEAF)
    with pytest.raises(DocumentError, match="more than 50000 nodes"):
        load_behavior(tmp_path / "f0.yaml")


def test_a_very_long_chain_of_references_is_refused(tmp_path: Path) -> None:
    """A chain of 200 files is an error, not a stack overflow."""
    for i in range(200):
        (tmp_path / f"f{i}.yaml").write_text(reference(f"f{i + 1}.yaml"))
    with pytest.raises(DocumentError, match="more than 64 deep"):
        load_behavior(tmp_path / "f0.yaml")


def test_ten_thousand_states_load_without_growing_slower() -> None:
    """Ten times the states take far less than a hundred times as long; `benchmarks/engine.py` has the figures."""
    small, large = _loading_s(1_000), _loading_s(10_000)
    assert large < 40 * small


def _loading_s(count: int) -> float:
    """Return the least CPU time of three loads of a machine with `count` states."""
    states = "".join(
        f"      s{i}: {{state: a.B, with: {{x: {i}}}, transitions: {{ok: s{i + 1}}}}}\n" for i in range(count - 1)
    )
    head = "flexcell: 1\nname: x\noutcomes: [ok]\nroot:\n  machine:\n    initial: s0\n    states:\n"
    text = f"{head}{states}      s{count - 1}: {{state: a.B}}\n"
    took: list[float] = []
    for _ in range(3):
        start = time.process_time()
        behavior = parse_behavior(text, file="x.yaml")
        took.append(time.process_time() - start)
        assert len(behavior.root.children) == count
    return min(took)
