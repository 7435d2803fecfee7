"""Which kinds of values reach which readers: from states, parameters, initial values, items, references."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest

from engine.check.flow.value_type import (
    ANYTHING,
    TEXT,
    ConstantValue,
    ListValue,
    MappingValue,
    TypeFit,
    describe_inferred_type,
    type_fit,
    type_of_annotation,
)
from engine.messages import Pose
from states.motion.motion_target import EntryTarget, JointTarget
from tests.engine.check.checking import code_paths, findings_in_files, message_of


@pytest.mark.parametrize(
    ("kind", "due", "expected"),
    [
        (ConstantValue(1), float, TypeFit.YES),
        (ConstantValue(1.5), int, TypeFit.NO),
        (ConstantValue("a"), float, TypeFit.NO),
        (type_of_annotation(int), float, TypeFit.YES),
        (type_of_annotation(float), int, TypeFit.NO),
        (type_of_annotation(bool), int, TypeFit.NO),
        (type_of_annotation(str), float, TypeFit.NO),
        (type_of_annotation(str | None), float, TypeFit.NO),
        (type_of_annotation(str | None), str, TypeFit.MAYBE),
        (type_of_annotation(object), float, TypeFit.MAYBE),
        (ANYTHING, Pose, TypeFit.MAYBE),
        (type_of_annotation(dict[str, object]), Pose, TypeFit.MAYBE),
        (type_of_annotation(Pose), Pose, TypeFit.YES),
        (type_of_annotation(Pose), dict[str, object], TypeFit.NO),
        (type_of_annotation(Pose), EntryTarget, TypeFit.NO),
        (type_of_annotation(list[int]), tuple[float, ...], TypeFit.YES),
        (type_of_annotation(list[str]), tuple[float, ...], TypeFit.NO),
        (type_of_annotation(tuple[int, int]), tuple[float, float, float], TypeFit.NO),
        (type_of_annotation(Pose), object, TypeFit.YES),
        (ListValue((type_of_annotation(float), ConstantValue(1))), JointTarget, TypeFit.MAYBE),
        (ListValue((TEXT, ConstantValue(1))), JointTarget, TypeFit.NO),
        (MappingValue({"entry": TEXT}), JointTarget, TypeFit.YES),
        (MappingValue({"entyr": TEXT}), JointTarget, TypeFit.NO),
        (MappingValue({"xyz": ANYTHING}), Pose, TypeFit.MAYBE),
    ],
)
def test_a_kind_fits_where_every_value_of_it_is_accepted(kind: Any, due: Any, expected: TypeFit) -> None:
    """YES, NO, or MAYBE where it depends on the value."""
    assert type_fit(kind, due) is expected


@pytest.mark.parametrize("value", [1, 1.5, True, None, "a", [1, 2], ["a"], {"xyz": [0, 0, 0]}, {"entry": "a"}])
@pytest.mark.parametrize("due", [int, float, bool, str, tuple[float, ...], Pose, JointTarget, dict[str, object]])
def test_the_type_of_a_value_never_contradicts_the_value(value: object, due: Any) -> None:
    """Where the value itself is accepted, its type is not refused, and the other way round."""
    accepted = type_fit(ConstantValue(value), due) is TypeFit.YES
    by_type = type_fit(type_of_annotation(type(value) if value is not None else None), due)
    assert by_type is not TypeFit.NO if accepted else by_type is not TypeFit.YES
    assert accepted is _converts(value, due)


def _converts(value: object, due: Any) -> bool:
    try:
        msgspec.convert(value, due)
    except msgspec.ValidationError:
        return False
    return True


def test_kinds_are_named_as_authors_know_them() -> None:
    """No class names of Python's where there is a plain word."""
    shown = [
        describe_inferred_type(type_of_annotation(kind))
        for kind in (str, float, int | None, tuple[float, ...], dict[str, int])
    ]
    assert shown == ["text", "a number", "an integer or nothing", "a list of numbers", "a mapping"]
    assert describe_inferred_type(ListValue((TEXT, ConstantValue(1)))) == "a list with text, `1`"


GRASP = "{state: gripper.Grasp, with: {gripper: left, width_m: 0.1}, transitions: {held: wait, missed: %s, failed: %s}}"
MOVE = "{state: motion.MoveJoints, with: {robot: left, target: %s}, transitions: {reached: good, failed: bad}}"
WAIT = "{state: flow.Wait, with: {duration_s: %s}, transitions: {done: good}}"


def machine(initial: str, **states: str) -> str:
    """Write a machine whose states are given on one line each."""
    lines = "".join(f"      {name}: {text}\n" for name, text in states.items())
    return f"root:\n  machine:\n    initial: {initial}\n    states:\n{lines}"


def test_an_initial_value_of_the_wrong_kind_is_named_with_its_key() -> None:
    """Both kinds, and where the value comes from."""
    text = "userdata: {pause: long}\n" + machine("wait", wait=WAIT % '"${pause}"')
    expected = "expects a number, but gets `long` from the initial value of `pause`"
    assert message_of(text) == f"the parameter `duration_s` of `flow.Wait` {expected}"


def test_what_a_state_writes_is_followed_to_its_reader() -> None:
    """`gripper.Grasp` writes whether it holds something, which is no duration."""
    text = machine("grasp", grasp=GRASP % ("bad", "bad"), wait=WAIT % '"${held}"')
    assert message_of(text).endswith("expects a number, but gets true or false from `held` of `root/grasp`")


def test_of_two_states_alike_the_one_is_named_that_the_value_comes_from() -> None:
    """The first one is behind the reader."""
    first = (GRASP % ("bad", "bad")).replace("held: wait", "held: good")
    wait = (WAIT % '"${held}"').replace("good", "first")
    text = machine("second", first=first, second=GRASP % ("bad", "bad"), wait=wait)
    assert message_of(text).endswith("gets true or false from `held` of `root/second`")


def test_a_value_that_comes_on_one_way_only_is_a_warning_with_that_way() -> None:
    """The other way brings a number."""
    grasp = GRASP % ("wait", "look")
    look = "{state: gripper.CheckHeld, with: {gripper: left}, transitions: {held: wait, lost: bad}}"
    text = "userdata: {width_m: unknown}\n" + machine("grasp", grasp=grasp, look=look, wait=WAIT % '"${width_m}"')
    assert code_paths(text) == ["maybe-type-mismatch root/wait"]
    assert message_of(text).endswith(
        "may get `unknown` from the initial value of `width_m` on the path grasp → look → wait"
    )


def test_a_value_that_is_put_into_a_key_keeps_its_kind() -> None:
    """`flow.SetValue` hands on what it is given, be it an expression of other keys."""
    put = "{state: flow.SetValue, with: {value: %s}, out: {value: pause}, transitions: {done: wait}}"
    head = "userdata: {count: 1, pause: none}\n"
    assert code_paths(head + machine("put", put=put % '"${count * 2}"', wait=WAIT % '"${pause}"')) == []
    assert code_paths(head + machine("put", put=put % '"${string(count)}"', wait=WAIT % '"${pause}"')) == [
        "type-mismatch root/wait"
    ]


def test_a_counter_is_a_number_however_often_it_is_counted() -> None:
    """The kind of a key that depends on itself is found from its initial value."""
    put = '{state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}, transitions: {done: wait}}'
    wait = '{state: flow.Wait, with: {duration_s: "${count}"}, transitions: {done: look}}'
    look = '{state: flow.Decide, with: {when: "${count}"}, transitions: {"true": put, "false": good}}'
    text = "userdata: {count: 0}\n" + machine("put", put=put, wait=wait, look=look)
    assert message_of(text).endswith("expects true or false, but gets an integer from `value` of `root/put`")


@pytest.mark.parametrize(
    ("expression", "says"),
    [
        ("${name + 1}", "`+` cannot be applied to text and an integer"),
        ("${size(count)}", "`size` cannot be applied to an integer"),
        ("${name.first}", "text has no fields"),
        ("${!count}", "`!` cannot be applied to an integer"),
        ("${name > 2}", "`>` cannot be applied to text and an integer"),
        ("${name == 2}", ""),
        ("${count < 2.5}", ""),
        ("${count == 1 ? 1 : 2.5}", ""),
        ("${name == null ? 1 : 2}", ""),
        ("${later.x + 1}", ""),
        ("${speed / count}", ""),
    ],
)
def test_an_expression_that_fails_with_the_kinds_it_gets_is_found(expression: str, says: str) -> None:
    """Only what fails when run; comparing unlike values, say, works."""
    text = "parameters: {speed: {type: number, default: 1}}\nuserdata: {name: a, count: 1, later: null}\n"
    text += machine(
        "say", say=f"{{state: flow.Log, with: {{message: '{expression} ${{speed}}'}}, transitions: {{done: good}}}}"
    )
    assert says in message_of(text) if says else code_paths(text) == []


def test_a_guard_takes_a_truth_value_and_a_foreach_a_list() -> None:
    """Their expressions are compared like parameters."""
    text = "userdata: {count: 1}\nroot:\n  %s\n"
    wait = '{state: flow.Wait, with: {duration_s: 1}, guard: {when: "${count}", to: bad}, transitions: {done: good}}'
    guard = text % f"machine: {{initial: w, states: {{w: {wait}}}}}"
    each = 'foreach: {items: "${count}", child: {state: flow.Log, with: {message: "${string(item)}"}}}'
    assert message_of(guard) == "the guard expects true or false, but gets `1` from the initial value of `count`"
    head = "flexcell: 1\nname: t\noutcomes: [exhausted, broken]\n"
    assert message_of(head + text % each).startswith("`items` expects a list of values, but gets `1`")
    assert message_of(head + text % each.replace("items", "times").replace("count", "count == 1")).startswith("`times`")


def test_the_items_of_a_list_are_what_a_round_reads() -> None:
    """One of them is no number."""
    each = "foreach: {items: [1, 2, three], as: pause, child: {state: flow.Wait, with: {duration_s: '${pause}'}}}"
    text = f"flexcell: 1\nname: t\noutcomes: [exhausted, broken]\nroot:\n  {each}\n"
    assert message_of(text).endswith("expects a number, but may get `three` from `pause` of the rounds of `root`")


def test_a_list_or_mapping_with_expressions_is_looked_into() -> None:
    """A list of joint angles takes no text."""
    text = "userdata: {name: a}\n" + machine("move", move=MOVE % "[0, '${name}']")
    assert message_of(text).endswith("expects EntryTarget or a list of numbers, but gets a list with `0`, `a`")


PART = """
parameters: {pause: {type: integer, default: 1, unit: s}}
userdata: {label: none, count: 0}
root:
  machine:
    initial: say
    states:
      say: {state: flow.Log, with: {message: "${label}"}, transitions: {done: wait}}
      wait: {state: flow.Wait, with: {duration_s: "${pause}"}, transitions: {done: good}}
"""


def test_what_a_reference_passes_in_is_followed_to_its_reader(tmp_path: Path) -> None:
    """The finding stands at the key that is passed, and names the reader inside."""
    main = "userdata: {n: 4}\n" + machine(
        "sub", sub="{behavior: part.yaml, in: {label: n}, transitions: {good: good, bad: bad}}"
    )
    (finding,) = findings_in_files(tmp_path, part=PART, main=main)
    assert (finding.code, finding.path) == ("type-mismatch", "root/sub")
    expected = "expects text, at `root/say` of `part.yaml`, but gets `4` through `label`"
    assert finding.message == f"the parameter `message` of `flow.Log` {expected}"


def test_what_a_reference_gives_back_has_the_kind_it_has_inside(tmp_path: Path) -> None:
    """`label` is what was passed in, `count` its own initial value."""
    sub = "{behavior: part.yaml, in: {label: name}, out: {%s: pause}, transitions: {good: wait, bad: bad}}"
    head = "userdata: {name: a, pause: 1}\n"
    good = findings_in_files(tmp_path, part=PART, main=head + machine("s", s=sub % "count", wait=WAIT % '"${pause}"'))
    bad = findings_in_files(tmp_path, part=PART, main=head + machine("s", s=sub % "label", wait=WAIT % '"${pause}"'))
    assert [finding.code for finding in good] == []
    assert [finding.message.partition("gets ")[2] for finding in bad] == ["`a` from `label` of `root/s`"]


def test_a_parameter_of_a_reference_takes_its_declared_type(tmp_path: Path) -> None:
    """A number is no integer, whatever its value."""
    main = "parameters: {p: {type: number, default: 2.5, unit: s}}\n"
    main += machine("sub", sub="{behavior: part.yaml, with: {pause: '${p}'}, transitions: {good: good, bad: bad}}")
    (finding,) = findings_in_files(tmp_path, part=PART, main=main)
    assert (
        finding.message
        == "the parameter `pause` of `part.yaml` expects an integer, but gets a number from the parameter `p`"
    )


def test_choices_are_compared_one_by_one() -> None:
    """One that the state does not take is a warning."""
    head = "parameters: {level: {type: string, default: info, choices: [info, loud]}}\n"
    text = head + machine(
        "say", say="{state: flow.Log, with: {message: a, level: '${level}'}, transitions: {done: good}}"
    )
    assert "may get `loud` from the parameter `level`" in message_of(text)
