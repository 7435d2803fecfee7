"""Behaviors made in Python are those that YAML describes."""

from __future__ import annotations

from typing import cast

import pytest

from engine.authoring import (
    Guard,
    Preempt,
    Retry,
    Step,
    Timeout,
    behavior,
    behaviour,
    concurrency,
    condition,
    cooldown,
    expr,
    foreach,
    guard,
    inverter,
    machine,
    one_shot,
    parallel,
    parameter,
    priority,
    reference,
    remap,
    repeat,
    retry,
    selector,
    sequence,
    state,
    timeout,
    tree,
)
from engine.document import Behavior, load_behavior, parse_behavior
from engine.errors import DocumentError, ExpressionError
from engine.messages import Pose
from tests.engine.fake_states import Count, Give, Write

HEAD = "flexcell: 1\nname: x\noutcomes: [good, bad]\n"


def _made(root: Step) -> Behavior:
    return behavior("x", outcomes=["good", "bad"], root=root)


def _read(text: str) -> Behavior:
    return parse_behavior(HEAD + text, file="x.yaml")


def test_every_key_of_a_step_is_written() -> None:
    """The keys that hold for all kinds, and those of a state."""
    made = _made(
        machine(
            initial="s",
            userdata={"seen": [1, 2.5, None]},
            states={
                "s": state(
                    Write(value=expr("seen"), after_s=2.0),
                    outputs={"value": "last"},
                    transitions={"done": "good"},
                    guard=Guard(when=expr("size(seen) > 1"), to="bad"),
                    timeout=Timeout(after="30 s", to="bad"),
                    retry=Retry(times=2, backoff=0.5, outcomes=("done",), errors=False),
                    on_error="bad",
                    autonomy={"done": "high"},
                    resume="ask",
                    description="All of it",
                ),
                "c": state("test.Count", parameters={"up_to": 2}, inputs={"count": "n"}, transitions={"full": "good"}),
            },
        )
    )
    read = _read("""
root:
  machine:
    initial: s
    userdata: {seen: [1, 2.5, null]}
    states:
      s:
        description: All of it
        state: test.Write
        with: {value: "${seen}", after_s: 2.0}
        out: {value: last}
        transitions: {done: good}
        guard: {when: "${size(seen) > 1}", to: bad}
        timeout: {after: 30 s, to: bad}
        retry: {times: 2, backoff: 0.5, outcomes: [done], errors: false}
        on_error: bad
        autonomy: {done: high}
        resume: ask
      c: {state: test.Count, with: {up_to: 2}, in: {count: n}, transitions: {full: good}}
""")
    assert made.document == read.document
    assert made.meaning == read.meaning


def test_every_container_is_written() -> None:
    """Priority inside concurrency beside rounds."""
    give = state(Give(outcome="b"))
    made = _made(
        concurrency(
            states={
                "first": priority(initial="g", states={"g": state(Give(), transitions={"a": "ok"})}),
                "rounds": foreach(
                    give, items=[1, "x"], item="thing", index="i", next=["b"], collect={"n": "all"}, userdata={"n": 0}
                ),
                "times": foreach(state(Give), times=expr("2 + 1")),
            },
            conditions=[
                ("good", {"first": "ok", "rounds": "exhausted"}),
                Preempt(["times"], {"first": "ok", "rounds": "broken", "at_least": 1}),
                ("bad", {"rounds": "broken"}),
            ],
            otherwise="bad",
            userdata={"all": []},
        )
    )
    read = _read("""
root:
  concurrency:
    states:
      first: {priority: {initial: g, states: {g: {state: test.Give, transitions: {a: ok}}}}}
      rounds:
        foreach:
          child: {state: test.Give, with: {outcome: b}}
          items: [1, x]
          as: thing
          index: i
          next: [b]
          collect: {n: all}
          userdata: {n: 0}
      times: {foreach: {child: {state: test.Give}, times: "${2 + 1}"}}
    conditions:
      - {good: {first: ok, rounds: exhausted}}
      - {preempt: [times], when: {first: ok, rounds: broken, at_least: 1}}
      - {bad: {rounds: broken}}
    otherwise: bad
    userdata: {all: []}
""")
    assert made.document == read.document
    assert made.meaning == read.meaning


def test_every_part_of_a_tree_is_written() -> None:
    """Composites with and without memory, all decorators, leaves with a name and a success of their own."""
    leaf = state(Give(outcome="c"), name="leaf", success=["c"])
    made = _made(
        tree(
            sequence(
                selector(leaf, inverter(leaf), memory=True, name="first", description="either"),
                parallel(leaf, one_shot(leaf), policy=["leaf"], synchronise=True),
                parallel(leaf, one_shot(leaf, policy="success")),
                repeat(cooldown(leaf, after="1 s"), times=2),
                remap(condition(leaf, status="success"), failure="running"),
                retry(timeout(guard(leaf, when=expr("1 < 2")), after=3.0), times=4, backoff="100 ms"),
                behaviour("py_trees.behaviours:Success", parameters={"name": "yes"}, name="foreign"),
                memory=False,
            )
        )
    )
    leaf_text = "{state: test.Give, with: {outcome: c}, name: leaf, success: [c]}"
    read = _read(f"""
root:
  tree:
    sequence:
      memory: false
      children:
        - name: first
          description: either
          selector: {{memory: true, children: [{leaf_text}, {{inverter: {{child: {leaf_text}}}}}]}}
        - parallel: {{children: [{leaf_text}, {{one_shot: {{child: {leaf_text}}}}}], policy: [leaf], synchronise: true}}
        - parallel: [{leaf_text}, {{one_shot: {{child: {leaf_text}, policy: success}}}}]
        - repeat: {{times: 2, child: {{cooldown: {{after: 1 s, child: {leaf_text}}}}}}}
        - remap: {{failure: running, child: {{condition: {{status: success, child: {leaf_text}}}}}}}
        - retry:
            times: 4
            backoff: 100 ms
            child: {{timeout: {{after: 3.0, child: {{guard: {{when: "${{1 < 2}}", child: {leaf_text}}}}}}}}}
        - {{behaviour: "py_trees.behaviours:Success", with: {{name: "yes"}}, name: foreign}}
""")
    assert made.document == read.document
    assert made.meaning == read.meaning


def test_the_head_of_a_behavior_is_written() -> None:
    """Parameters of all kinds, userdata, cell, view."""
    made = behavior(
        "x",
        outcomes=["good"],
        success=["good"],
        description="A head",
        parameters=[
            parameter("n", float, default=1.0, minimum=0.0, maximum=2.0, unit="m", label="N", description="How far"),
            parameter("i", int, choices=[1, 2]),
            parameter("t", str, default=""),
            parameter("b", bool, default=False),
            parameter("p", Pose, default=Pose(xyz=(0.0, 0.0, 1.0))),
            parameter("j", tuple[float, ...], default=(0.0, 1.0)),
            parameter("l", list[object], default=[1]),
            parameter("m", dict[str, object], default={}),
        ],
        userdata={"k": {"deep": [True]}},
        cell="cells/c.yaml",
        view={"root": (1.0, 2.0)},
        root=state(Give()),
    )
    read = parse_behavior(
        """
flexcell: 1
name: x
description: A head
outcomes: [good]
success: [good]
parameters:
  n: {type: number, default: 1.0, minimum: 0.0, maximum: 2.0, unit: m, label: N, description: How far}
  i: {type: integer, choices: [1, 2]}
  t: {type: string, default: ""}
  b: {type: boolean, default: false}
  p: {type: pose, default: {xyz: [0.0, 0.0, 1.0]}}
  j: {type: joints, default: [0.0, 1.0]}
  l: {type: list, default: [1]}
  m: {type: mapping, default: {}}
userdata: {k: {deep: [true]}}
cell: cells/c.yaml
root: {state: test.Give}
view: {root: [1.0, 2.0]}
""",
        file="x.yaml",
    )
    assert made.document == read.document
    assert made.meaning == read.meaning
    assert made.cell_file is not None
    assert made.cell_file.name == "c.yaml"


def test_a_step_may_stand_in_several_places() -> None:
    """Steps are values; each place is a node of its own."""
    give = state(Give(), transitions={"a": "good", "b": "second"})
    made = _made(machine(initial="first", states={"first": give, "second": give}))
    assert [path for path, _ in made.nodes()] == ["root", "root/first", "root/second"]


def test_a_behavior_refers_to_others(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Made in Python, or read from a file: the meaning is that of the documents they would be."""
    folder = tmp_path_factory.mktemp("references")
    (folder / "inner.yaml").write_text(HEAD + "root: {state: test.Give}\n", encoding="utf-8")
    inner = load_behavior(folder / "inner.yaml")
    also = behavior("also", outcomes=["good"], root=state(Count(up_to=1)), file=str(folder / "sub" / "also.yaml"))
    outer = behavior(
        "outer",
        outcomes=["good"],
        file=str(folder / "outer.yaml"),
        root=machine(
            initial="one",
            states={
                "one": reference(inner, parameters={"speed": 1}, transitions={"good": "two"}),
                "two": reference(also, inputs={"count": "n"}, outputs={"count": "n"}, transitions={"good": "three"}),
                "three": reference("inner.yaml", transitions={"good": "good"}),
            },
        ),
    )
    assert [node.behavior for _, node in outer.nodes() if node.behavior] == [
        "inner.yaml", "sub/also.yaml", "inner.yaml",
    ]  # fmt: skip
    assert outer.references == {"inner.yaml": inner, "sub/also.yaml": also}


def test_two_behaviors_for_one_file_are_refused() -> None:
    """They would overwrite one another."""
    one = behavior("same", outcomes=["a"], root=state(Give()))
    other = behavior("same", outcomes=["a"], root=state(Give(outcome="b")))
    states = {
        "one": reference(one, transitions={"a": "other"}),
        "other": reference(other, transitions={"a": "good"}),
    }
    with pytest.raises(DocumentError, match=r"two different behaviors would both be written as `same\.yaml`"):
        _made(machine(initial="one", states=states))


def test_parameters_stand_for_their_values() -> None:
    """As a value of their type, inside text, and in a mapping."""
    speed = parameter("speed", float)
    made = behavior(
        "x",
        outcomes=["a"],
        parameters=[speed],
        root=state("test.Any", parameters={"a": speed.value, "b": f"at {speed}", "c": [speed], "d": expr("speed * 2")}),
    )
    assert made.root.parameters == {"a": "${speed}", "b": "at ${speed}", "c": ["${speed}"], "d": "${speed * 2}"}


@pytest.mark.parametrize(("text", "message"), [("1 +", "mismatched input"), ("${speed}", "contains"), ("", "empty")])
def test_an_expression_is_compiled_where_it_is_written(text: str, message: str) -> None:
    """Not when the behavior runs."""
    with pytest.raises(ExpressionError, match=message) as raised:
        expr(text)
    assert "test_behavior_builder.py" in str(raised.value.where)


def test_a_parameter_needs_a_kind_and_a_name_of_its_own() -> None:
    """Errors name the place of the declaration."""
    with pytest.raises(DocumentError, match="a parameter cannot be a"):
        parameter("x", cast("type[str]", bytes))
    twice = [parameter("x", int, default=1), parameter("x", float, default=1.0)]
    with pytest.raises(DocumentError, match="two parameters are named `x`"):
        behavior("x", outcomes=["a"], parameters=twice, root=state(Give()))


def test_what_is_no_valid_behavior_is_refused_like_a_document() -> None:
    """The rules of structure are those of documents."""
    with pytest.raises(DocumentError, match="the root has no transitions"):
        _made(state(Give(), transitions={"a": "good"}))
    with pytest.raises(DocumentError, match="the key `to` is missing"):
        _made(state(Give(), timeout=Timeout(after=1.0)))
    with pytest.raises(DocumentError, match="not in the allowed form"):
        _made(machine(initial="a b", states={"a b": state(Give())}))


def test_nodes_nested_deeper_than_a_document_may_be_are_refused() -> None:
    """They could run but never be saved."""
    step = state(Give(), transitions={"a": "good"})
    for _ in range(40):
        step = machine(initial="s", states={"s": step})
    with pytest.raises(DocumentError, match="nested deeper than 64 levels"):
        _made(step)
