"""Every structural mistake of a document is reported where it stands, and none hides the others."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.check import check_survey
from engine.document import load_behavior, parse_behavior, survey_behavior
from engine.document.text.mistakes import MAX_MISTAKES
from engine.errors import DocumentError, Position
from tests.engine.fake_states import CATALOGUE

HEAD = """flexcell: 1
name: many
parameters: {outcome: {type: string, default: a}}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: s0
    userdata: {value: 0}
    states:
"""
LAST = '{state: test.Give, with: {outcome: "${outcome}"}, transitions: {a: good, b: bad, c: bad}}'
KINDS: tuple[str, ...] = (
    '{state: test.Give, with: {outcome: "${outcome}"}, transitions: {a: NEXT, b: bad, c: bad}}',
    "{state: test.Write, with: {value: 1}, transitions: {done: NEXT}, timeout: {after: 1 s, to: bad}}",
    "{concurrency: {states: {one: {state: test.Give}, two: {state: test.Write}}, conditions: [{end: {two: done}}]}, "
    "transitions: {end: NEXT}}",
    "{machine: {initial: x, states: {x: {state: test.Give, transitions: {a: on, b: on, c: on}}}}, "
    "transitions: {on: NEXT}}",
    "{tree: {sequence: [{state: test.Write}, {state: test.Give}]}, transitions: {success: NEXT, failure: bad}}",
    "{foreach: {times: 2, child: {state: test.Write}}, transitions: {exhausted: NEXT, broken: bad}}",
)
"""Nodes of each kind, each on a line of its own."""


def with_key(text: str, key: str) -> str:
    """A node with one more key."""
    return f"{text[:-1]}, {key}}}"


MISTAKES: tuple[Callable[[str], str], ...] = (
    lambda node: with_key(node, "flavour: 3"),
    lambda node: with_key(node, "retry: {tims: 3}"),
    lambda node: with_key(node, "retry: {times: 0}"),
    lambda node: with_key(node, "autonomy: {a: medium}"),
    lambda node: with_key(node, "guard: {when: '${true}'}"),
    lambda node: with_key(node, "success: [a]"),
    lambda node: with_key(node, "behavior: other.yaml"),
    lambda node: with_key(node, "every: 3 sek"),
    lambda node: node.replace("transitions: {", "transitions: {odd: 3, "),
    lambda node: node.replace("transitions: {", "transitons: {"),
    lambda _: "{}",
    lambda _: "17",
    lambda _: "{state: [test.Give], transitions: {a: NEXT, b: bad}}",
    lambda _: "{machine: {states: {x: {state: test.Write, transitions: {done: on}}}}, transitions: {on: NEXT}}",
    lambda _: "{machine: {initial: x, states: {}}, transitions: {on: NEXT}}",
    lambda _: "{machne: {initial: x, states: {}}, transitions: {on: NEXT}}",
    lambda _: "{tree: {sequence: []}, transitions: {success: NEXT}}",
    lambda _: "{foreach: {times: 2}, transitions: {exhausted: NEXT}}",
    lambda _: "{concurrency: {states: {}, conditions: [3]}, transitions: {on: NEXT}}",
    lambda _: "{inverter: {child: {state: test.Give}}}",
)


def behavior_of(nodes: list[str]) -> str:
    """A machine that goes through these nodes, one a line."""
    lines = [
        f"      s{number}: {node.replace('NEXT', f's{number + 1}' if number + 1 < len(nodes) else 'last')}\n"
        for number, node in enumerate(nodes)
    ]
    return f"{HEAD}{''.join(lines)}      last: {LAST}\n"


def lines_of(mistakes: tuple[DocumentError, ...]) -> list[int]:
    """The lines that mistakes are on."""
    return [each.where.line for each in mistakes if isinstance(each.where, Position)]


@settings(deadline=None)
@given(st.data())
def test_as_many_mistakes_as_there_are_are_reported_each_on_its_line_and_nothing_follows_from_them(
    data: st.DataObject,
) -> None:
    """In different nodes of a document that nothing else is wrong with."""
    nodes = data.draw(st.lists(st.sampled_from(KINDS), min_size=1, max_size=8))
    wrong = data.draw(st.sets(st.integers(0, len(nodes) - 1), min_size=1))
    made = {number: data.draw(st.sampled_from(MISTAKES)) for number in wrong}
    text = behavior_of([made[number](node) if number in made else node for number, node in enumerate(nodes)])
    survey = survey_behavior(Path("x.yaml"), text)
    first = HEAD.count("\n") + 1
    assert sorted(set(lines_of(survey.mistakes))) == [first + number for number in sorted(wrong)]
    findings = check_survey(survey, Path("x.yaml"), CATALOGUE)
    assert [str(each) for each in findings if each.code != "invalid-document"] == []


@given(st.lists(st.sampled_from(KINDS), min_size=1, max_size=8))
@settings(deadline=None)
def test_without_mistakes_there_is_nothing_to_report(nodes: list[str]) -> None:
    survey = survey_behavior(Path("x.yaml"), behavior_of(nodes))
    assert survey.mistakes == ()
    assert check_survey(survey, Path("x.yaml"), CATALOGUE) == ()


def test_the_check_goes_on_around_a_mistake() -> None:
    """In the same machine, and in the parts of a container with a mistake of its own."""
    text = behavior_of(["{state: test.Give, with: {outcom: a}, transitions: {a: NEXT, b: bad, c: bad}}", "5"]).replace(
        "machine:", "descripton: a\n  machine:"
    )
    findings = check_survey(survey_behavior(Path("x.yaml"), text), Path("x.yaml"), CATALOGUE)
    assert [(each.position.line, each.code) for each in findings] == [
        (7, "invalid-document"),
        (12, "unknown-parameter"),
        (13, "invalid-document"),
    ]


@pytest.mark.parametrize("key", ["root", "machine", "states", "parameters"])
def test_a_mistyped_key_is_reported_and_read_as_it_was_meant(key: str) -> None:
    """What stands below it is looked at, too."""
    text = behavior_of(["{state: test.Give, tarnsitions: {}, timeout: {after: soon, to: bad}}"])
    survey = survey_behavior(Path("x.yaml"), text.replace(f"{key}:", f"{key[:-1]}:", 1))
    assert f"unknown key `{key[:-1]}`" in str(survey.mistakes)
    assert lines_of(survey.mistakes).count(11) == 2


def test_the_places_below_a_mistyped_key_are_right() -> None:
    text = behavior_of(["{state: test.Give, with: {outcom: a}, transitions: {a: NEXT, b: bad, c: bad}}"])
    survey = survey_behavior(Path("x.yaml"), text.replace("states:", "staets:"))
    findings = check_survey(survey, Path("x.yaml"), CATALOGUE)
    assert [(each.position.line, each.position.column) for each in findings] == [(10, 5), (11, 37)]


def test_a_key_that_resembles_another_one_by_chance_is_only_reported() -> None:
    """What stands there is nothing that it could mean."""
    text = behavior_of(["{state: test.Give, outs: 5, transitions: {a: NEXT, b: bad, c: bad}}"])
    assert [each.message for each in survey_behavior(Path("x.yaml"), text).mistakes] == ["unknown key `outs`"]


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ("{good: {at_least: 1}}", ["there are only 0 children in this condition"]),
        ("{good: {one: 3}}", ["`one`: 3 is not an outcome"]),
        (
            "{good: {one: 3, at_least: 2}}",
            ["`one`: 3 is not an outcome", "there are only 0 children in this condition"],
        ),
        ("{good: {one: 3, two: done}}", ["`one`: 3 is not an outcome"]),
        ("{good: {one: a}}, {bad: {at_least: 1}}, {bad: {two: 1}}", ["there are only 0 children", "`two`: 1 is no"]),
        ("{preempt: [one]}", ["a condition with `preempt` requires `when`"]),
        ("{preempt: [one], good: {two: done}}", ["a condition decides an outcome or has `preempt`, not both"]),
        ("{preempt: [one], when: {two: 3}}", ["`two`: 3 is not an outcome"]),
        ("{preempt: [one], when: {}}", ["`when`: expected mapping of length >= 1"]),
        ("{good: {one: a}, bad: {one: b}}, {preempt: [one, one], when: {two: done}}", ["one outcome", "is repeated"]),
    ],
)
def test_a_condition_of_which_nothing_is_left_is_left_out(condition: str, expected: list[str]) -> None:
    """Each mistake in it is reported, and the check goes on around it."""
    text = f"""flexcell: 1
name: many
outcomes: [good, bad]
success: [good]
root:
  concurrency:
    states: {{one: {{state: test.Give}}, two: {{state: test.Wrote}}}}
    conditions: [{condition}]
    otherwise: bad
"""
    survey = survey_behavior("many.yaml", text)
    findings = [each.message for each in check_survey(survey, "many.yaml", CATALOGUE)]
    for message in expected:
        assert any(message in each for each in findings), findings
    assert "there is no state `test.Wrote`" in findings
    assert len(findings) == len(expected) + 1


def test_a_run_is_refused_with_the_first_and_knows_the_others() -> None:
    text = behavior_of(["5", "{}"])
    with pytest.raises(DocumentError, match="`s0`: expected mapping, got integer") as refusal:
        parse_behavior(text, file="x.yaml")
    assert refusal.value.others == ()
    with pytest.raises(DocumentError, match="`s0`: expected mapping, got integer") as refusal:
        parse_behavior(behavior_of(["5", "6"]), file="x.yaml")
    assert [each.message for each in refusal.value.others] == ["`s1`: expected mapping, got integer"]


def test_the_mistakes_of_behaviors_that_are_referred_to_are_reported_in_their_files(tmp_path: Path) -> None:
    """Missing and unreadable files among them, each once."""
    reference = "{behavior: NAME.yaml, transitions: {good: NEXT, bad: bad}}"
    names = ["inner", "inner", "none", "torn"]
    (tmp_path / "inner.yaml").write_text(behavior_of(["5", "{}"]), encoding="utf-8")
    (tmp_path / "torn.yaml").write_text("a: [", encoding="utf-8")
    outer = tmp_path / "outer.yaml"
    outer.write_text(behavior_of([reference.replace("NAME", name) for name in names]), encoding="utf-8")
    survey = survey_behavior(outer)
    places = [
        (Path(each.where.file).name, each.where.line) for each in survey.mistakes if isinstance(each.where, Position)
    ]
    assert places == [("inner.yaml", 11), ("inner.yaml", 12), ("outer.yaml", 13), ("torn.yaml", 2)]
    assert {each.code for each in check_survey(survey, outer, CATALOGUE)} == {"invalid-document"}
    with pytest.raises(DocumentError):
        load_behavior(outer)


def test_of_another_version_only_that_is_reported() -> None:
    text = behavior_of(["5"]).replace("flexcell: 1", "flexcell: 2")
    assert [each.message for each in survey_behavior(Path("x.yaml"), text).mistakes] == [
        "`flexcell`: there is no choice 2"
    ]


@pytest.mark.parametrize(
    "node", ["5", "{}", "{state: test.Give, x: 1}", "{sequence: [{state: test.Give}]}", "{machine: {states: {a: 5}}}"]
)
def test_ten_thousand_mistakes_are_bounded(node: str) -> None:
    """Some of them are reported, in a time that does not depend on how many there are."""
    text = behavior_of([node] * 10_000)
    began_s = time.process_time()
    survey = survey_behavior(Path("x.yaml"), text)
    check_survey(survey, Path("x.yaml"), CATALOGUE)
    assert 0 < len(survey.mistakes) <= MAX_MISTAKES
    assert time.process_time() - began_s < 10.0
