"""Parts of trees that never run or never end, and the arguments of py_trees classes."""

from __future__ import annotations

import pytest

from engine.check.end_statuses import BOTH, FAILURE, NEVER, SUCCESS, Statuses, end_statuses
from engine.document import parse_behavior
from tests.engine.check.checking import code_paths, findings_in

HEAD = "flexcell: 1\nname: t\noutcomes: [success, failure]\nroot:\n  tree:\n    "
LOG = "{state: flow.Log, with: {message: a}}"
DECIDE = "{state: gripper.CheckHeld, with: {gripper: left}}"


@pytest.mark.parametrize(
    ("part", "children", "expected"),
    [
        ("sequence: [<a>, <b>]", (BOTH, SUCCESS), BOTH),
        ("sequence: [<a>, <b>]", (SUCCESS, SUCCESS), SUCCESS),
        ("sequence: [<a>, <b>]", (FAILURE, SUCCESS), FAILURE),
        ("selector: [<a>, <b>]", (FAILURE, BOTH), BOTH),
        ("selector: [<a>, <b>]", (BOTH, SUCCESS), SUCCESS),
        ("selector: [<a>, <b>]", (NEVER, BOTH), NEVER),
        ("parallel: [<a>, <b>]", (SUCCESS, SUCCESS), SUCCESS),
        ("parallel: [<a>, <b>]", (SUCCESS, BOTH), BOTH),
        ("parallel: {policy: one, children: [<a>, <b>]}", (FAILURE, SUCCESS), BOTH),
        ("parallel: {policy: [b], children: [<a>, <b>]}", (FAILURE, FAILURE), FAILURE),
        ("inverter: {child: <a>}", (SUCCESS,), FAILURE),
        ("remap: {success: failure, child: <a>}", (SUCCESS,), FAILURE),
        ("remap: {success: running, child: <a>}", (BOTH,), FAILURE),
        ("remap: {success: running, child: <a>}", (SUCCESS,), NEVER),
        ("remap: {running: failure, child: <a>}", (SUCCESS,), BOTH),
        ("condition: {status: failure, child: <a>}", (SUCCESS,), NEVER),
        ("condition: {status: failure, child: <a>}", (BOTH,), SUCCESS),
        ("condition: {status: running, child: <a>}", (SUCCESS,), SUCCESS),
        ("timeout: {after: 1, child: <a>}", (SUCCESS,), BOTH),
        ("cooldown: {after: 1, child: <a>}", (SUCCESS,), BOTH),
        ("{timeout: {after: 1, child: <a>}, guard: {when: '${x}', to: success}}", (SUCCESS,), BOTH),
        ("{cooldown: {after: 1, child: <a>}, guard: {when: '${x}', to: skipped}}", (SUCCESS,), BOTH),
        ("guard: {when: '${x}', child: <a>}", (SUCCESS,), BOTH),
        ("retry: {times: 1, child: <a>}", (FAILURE,), FAILURE),
        ("repeat: {times: 2, child: <a>}", (SUCCESS,), SUCCESS),
        ("one_shot: {child: <a>}", (BOTH,), BOTH),
    ],
)
def test_the_ends_of_a_part_follow_from_those_of_its_children(
    part: str, children: tuple[Statuses, ...], expected: Statuses
) -> None:
    """As py_trees would have them."""
    text = part.replace("<a>", "{state: x.A, name: a}").replace("<b>", "{state: x.B, name: b}")
    node = parse_behavior(f"{HEAD}{text}\n", file="t.yaml").root.children
    (only,) = node.values()
    assert end_statuses(only, list(zip(only.children, children, strict=True))) == expected


def test_nobody_is_asked_after_a_child_that_decides() -> None:
    """A selector after success, a sequence after failure; `success` on a leaf changes what means what."""
    assert code_paths(f"{HEAD}selector: [{LOG}, {DECIDE}]\n") == ["unreachable-node root/selector/CheckHeld"]
    assert code_paths(f"{HEAD}sequence: [{{inverter: {{child: {LOG}}}}}, {DECIDE}]\n") == [
        "unreachable-node root/sequence/CheckHeld"
    ]
    assert code_paths(f"{HEAD}selector: [{DECIDE}, {LOG}]\n") == []
    always = "{state: gripper.CheckHeld, with: {gripper: left}, success: [held, lost]}"
    assert code_paths(f"{HEAD}selector: [{always}, {LOG}]\n") == ["unreachable-node root/selector/Log"]


def test_a_part_that_never_ends_is_reported_once() -> None:
    """Not again for the parts around it."""
    never = f"{{remap: {{success: running, failure: running, child: {DECIDE}}}}}"
    assert code_paths(f"{HEAD}sequence: [{{inverter: {{child: {never}}}}}]\n") == [
        "never-ends root/sequence/inverter/remap"
    ]


def test_children_that_a_parallel_runs_again_until_all_succeed_at_once_are_reported() -> None:
    """One that takes time may wait for those that do not."""
    wait = "{state: flow.Wait, with: {duration_s: 1}}"
    later = "{state: flow.Wait, name: later, with: {duration_s: 3}}"
    unsynchronised = "parallel: {synchronise: false, children: [%s, %s]}\n"
    expected = "restarted-children root/parallel"
    assert code_paths(f"{HEAD}{unsynchronised % (wait, later)}") == [expected]
    assert code_paths(f"{HEAD}{unsynchronised % (wait, LOG)}") == []
    assert code_paths(f"{HEAD}{unsynchronised.replace('children', 'policy: [later], children') % (wait, later)}") == []
    assert code_paths(f"{HEAD}{unsynchronised.replace('children', 'policy: one, children') % (wait, later)}") == []
    assert code_paths(f"{HEAD}{unsynchronised.replace('false', 'true') % (wait, later)}") == []
    assert code_paths(f"{HEAD}parallel: [{wait}, {later}]\n") == []
    assert code_paths(f"{HEAD}parallel: [{wait}, {later}]\n") == []


def test_thresholds_that_no_child_can_reach_are_reported() -> None:
    """Of three that only succeed none fails; what stands behind it in a selector never runs."""
    wait = "{state: flow.Wait, name: w%s, with: {duration_s: 1}}"
    three = ", ".join(wait % number for number in range(3))
    parallel = f"{{parallel: {{success_count: 2, failure_count: 2, children: [{three}]}}}}"
    assert code_paths(f"{HEAD}selector: [{parallel}, {LOG}]\n") == ["unreachable-node root/selector/Log"]
    may_fail = parallel.replace(wait % 0, DECIDE).replace(wait % 1, f"{{inverter: {{child: {DECIDE}}}}}")
    assert code_paths(f"{HEAD}selector: [{may_fail}, {LOG}]\n") == []


def test_a_check_that_nothing_asks_again_is_reported() -> None:
    """It stands there to watch over a motion, which no tick interrupts."""
    motion = "{state: motion.MoveJoints, with: {robot: left, target: [0, -0.4, 0, -2.2, 0, 1.8, 0.8]}}"
    reactive = "%s: {memory: false, children: [%s, " + motion + "]}\n"
    scene = "{state: scene.Check, with: {robot: left}}"
    held = "{state: gripper.CheckHeld, with: {gripper: left}}"
    expected = "unwatched-check root/sequence/Check"
    assert code_paths(f"{HEAD}{reactive % ('sequence', scene)}") == [expected]
    assert code_paths(f"{HEAD}{reactive % ('selector', scene)}") == [expected.replace("sequence", "selector")]
    assert code_paths(f"{HEAD}{reactive % ('sequence', f'{{inverter: {{child: {scene}}}}}')}") == [
        "unwatched-check root/sequence/inverter/Check"
    ]
    assert code_paths(f"{HEAD}{reactive % ('sequence', f'{scene[:-1]}, every: 1 s}}')}") == []
    for watched in (held, DECIDE):
        assert code_paths(f"{HEAD}{reactive % ('sequence', watched)}") == []
    assert code_paths(f"{HEAD}sequence: [{scene}, {motion}]\n") == []


def test_a_period_that_is_never_used_is_reported() -> None:
    """At an action, at what nothing stands behind, and where there is memory."""
    every = ", every: 1 s}"
    held = "{state: gripper.CheckHeld, with: {gripper: left}" + every
    motion = "{state: motion.MoveJoints, with: {robot: left, target: [0, -0.4, 0, -2.2, 0, 1.8, 0.8]}" + every
    expected = "idle-every root/sequence/%s"
    assert code_paths(f"{HEAD}sequence: [{held}, {LOG}]\n") == [expected % "CheckHeld"]
    assert code_paths(f"{HEAD}sequence: {{memory: false, children: [{LOG}, {held}]}}\n") == [expected % "CheckHeld"]
    assert code_paths(f"{HEAD}sequence: {{memory: false, children: [{held}, {motion}]}}\n") == [expected % "MoveJoints"]


def test_an_end_that_never_occurs_need_not_be_connected() -> None:
    """A tree that only succeeds is connected with `success`; to connect `failure` as well does no harm."""
    tree = "{tree: {sequence: [{state: flow.Wait, with: {duration_s: 1}}]}, transitions: {success: good%s}}"
    text = "root:\n  machine:\n    initial: tree\n    states:\n      tree: " + tree + "\n"
    assert code_paths(text % "") == []
    assert code_paths(text % ", failure: bad") == []
    assert code_paths(
        (text % "").replace("flow.Wait, with: {duration_s: 1}", "gripper.CheckHeld, with: {gripper: l}")
    ) == ["unconnected-outcome root/tree"]


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("py_trees.behaviours:Success", "", None),
        ("py_trees.behaviours:TickCounter", "duration: 2, completion_status: SUCCESS", None),
        ("py_trees.behaviours:TickCounter", "duration: 2", "missing-parameter"),
        ("py_trees.behaviours:TickCounter", "duration: 2, completion_status: SUCCESS, x: 1", "unknown-parameter"),
        ("py_trees.behaviours:Nothing", "", "broken-behaviour"),
        ("no.such.module:Thing", "", "module-not-allowed"),
        ("pathlib:Path", "", "module-not-allowed"),
        ("py_trees.behaviour:Behaviour", "", "module-not-allowed"),
        ("py_trees", "", "module-not-allowed"),
        (":", "", "module-not-allowed"),
    ],
)
def test_a_py_trees_class_must_be_there_and_take_what_it_is_given(name: str, given: str, expected: str | None) -> None:
    """The engine gives the name where it is left out."""
    text = f'{HEAD}sequence: [{{behaviour: "{name}", with: {{{given}}}}}, {DECIDE}]\n'
    assert [finding.code for finding in findings_in(text)] == ([expected] if expected else [])


def test_a_branch_that_is_never_chosen_is_reported() -> None:
    """Where the condition always says the same."""
    branching = "if_then_else: {if: %s, then: {state: flow.Log, name: a, with: {message: a}}, else: %s}\n"
    expected = "unreachable-node root/if_then_else/"
    assert code_paths(f"{HEAD}{branching % (DECIDE, LOG)}") == []
    assert code_paths(f"{HEAD}{branching % (LOG, DECIDE)}") == [f"{expected}CheckHeld"]
    assert code_paths(f"{HEAD}{branching % (f'{{inverter: {{child: {LOG}}}}}', DECIDE)}") == [f"{expected}a"]


def test_a_condition_that_commands_what_its_branches_command_is_reported() -> None:
    """It is asked beside them; the branches take turns."""
    move = "{state: motion.MoveJoints, name: %s, with: {robot: %s, target: [0, -0.4, 0, -2.2, 0, 1.8, 0.8]}}"
    loop = "while_do_else: {while: %s, do: %s, else: %s}\n"
    both = (move % ("b", "left"), move % ("c", "left"))
    assert code_paths(f"{HEAD}{loop % (DECIDE, *both)}") == []
    assert code_paths(f"{HEAD}{loop % (move % ('a', 'left'), *both)}") == [
        "shared-resource root/while_do_else/b",
        "shared-resource root/while_do_else/c",
    ]


def test_the_condition_of_a_loop_is_one_that_can_be_asked_again() -> None:
    """As in front of an action in a composite without memory; a period belongs to it alone."""
    scene = "{state: scene.Check, with: {robot: left}%s}"
    motion = "{state: motion.MoveJoints, with: {robot: left, target: [0, -0.4, 0, -2.2, 0, 1.8, 0.8]}}"
    loop = "while_do_else: {while: %s, do: %s}\n"
    assert code_paths(f"{HEAD}{loop % (scene % '', motion)}") == ["unwatched-check root/while_do_else/Check"]
    assert code_paths(f"{HEAD}{loop % (scene % ', every: 1 s', motion)}") == []
    once = f"if_then_else: {{if: {scene % ''}, then: {motion}}}\n"
    assert code_paths(f"{HEAD}{once}") == []


def test_what_a_halted_branch_may_have_written_is_known_to_the_other() -> None:
    """`do` may be stopped after its first state, and `else` then reads what that wrote."""
    states = (
        "a: {state: flow.SetValue, with: {value: text}, out: {value: x}, transitions: {done: b}}, "
        "b: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: done}}"
    )
    machine = f"{{machine: {{initial: a, states: {{{states}}}}}}}"
    read = "{state: flow.Wait, with: {duration_s: '${x}'}}"
    head = HEAD.replace("root:", "userdata: {x: 1}\nroot:")
    choice = f"if_then_else: {{if: {DECIDE}, then: {machine}, else: {read}}}\n"
    assert code_paths(f"{head}{choice}") == []
    loop = f"while_do_else: {{while: {DECIDE}, do: {machine}, else: {read}}}\n"
    assert code_paths(f"{head}{loop}") == ["maybe-type-mismatch root/while_do_else/Wait"]


SKIPS = ", guard: {when: '${x}', to: skipped}}"


def test_what_stands_behind_a_child_that_may_be_skipped_can_be_asked() -> None:
    """Both in a sequence and in a selector; a tree that is skipped as a whole succeeds."""
    head = HEAD.replace("root:", "parameters: {x: {type: boolean, default: true}}\nroot:")
    fails = f"{{inverter: {{child: {LOG}}}}}"
    for kind, first in (("sequence", fails), ("selector", LOG)):
        assert code_paths(f"{head}{kind}: [{first}, {DECIDE}]\n") == [
            "unused-parameter root",
            f"unreachable-node root/{kind}/CheckHeld",
        ]
        assert code_paths(f"{head}{kind}: [{first[:-1]}{SKIPS}, {DECIDE}]\n") == []
    sequence = (
        "{tree: {sequence: [%s], guard: {when: '${x}', to: skipped}}, transitions: {success: good, failure: bad}}"
    )
    text = "root:\n  machine:\n    initial: tree\n    states:\n      tree: " + sequence % LOG + "\n"
    assert code_paths(text.replace("root:", "parameters: {x: {type: boolean, default: true}}\nroot:")) == []


def test_a_guard_of_a_part_is_compared_with_what_it_reads() -> None:
    """As that of a state."""
    part = f"sequence: [{LOG}]\n    guard: {{when: '${{%s}}', to: skipped}}\n"
    assert code_paths(f"{HEAD}{part % 'nothing'}") == ["undeclared-name root/sequence"]
    assert code_paths(f"{HEAD}{part % '1 < 2'}") == ["constant-guard root/sequence"]
    assert code_paths(f"{HEAD.replace('root:', 'userdata: {x: 1}' + chr(10) + 'root:')}{part % 'x'}") == [
        "type-mismatch root/sequence"
    ]


def test_what_post_conditions_write_and_read_is_followed() -> None:
    """Behind the end that they belong to, and in their order."""
    read = "{state: flow.Log, with: {message: '${string(x)}'}}"
    for kind, when, expected in (
        ("sequence", "on_success", []),
        ("sequence", "always", []),
        ("sequence", "on_failure", ["undefined-key"]),
        ("selector", "on_failure", []),
        ("selector", "on_halted", ["undefined-key"]),
    ):
        part = f"{DECIDE[:-1]}, post: {{{when}: {{x: 1}}}}}}"
        assert [finding.split()[0] for finding in code_paths(f"{HEAD}{kind}: [{part}, {read}]\n")] == expected, (
            kind,
            when,
        )
    given = "{x: 1, y: '${x + 1}'}"
    assert code_paths(f"{HEAD}sequence: [{DECIDE[:-1]}, post: {{on_success: {given}}}}}, {read}]\n") == []
    swapped = "{y: '${x + 1}', x: 1}"
    assert code_paths(f"{HEAD}sequence: [{DECIDE[:-1]}, post: {{on_success: {swapped}}}}}, {read}]\n") == [
        "undefined-key root/sequence/CheckHeld"
    ]
    assert code_paths(f"{HEAD}sequence: [{DECIDE[:-1]}, post: {{always: {{z: '${{1 +}}'}}}}}}]\n") == [
        "bad-expression root/sequence/CheckHeld"
    ]
