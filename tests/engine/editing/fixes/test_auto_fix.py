"""Fixes that need no choice are made, and only those."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.editing.fixes.auto_fix import FixResult, fix_text
from engine.editing.fixes.fix import is_typo
from engine.library.behavior_library import FindingView
from tests.engine.editing.edit_fixtures import context
from tests.engine.editing.test_fixes import FILE, LOOSE, SLIPS, findings_of, states
from tests.tiers import examples


def repaired(text: str, *, likely: bool = False) -> FixResult:
    """A text after the fixes that can be made."""
    return fix_text(text, file=FILE, context=context(FILE.parent), likely=likely)


def errors(findings: tuple[FindingView, ...]) -> int:
    """How many of them are errors."""
    return sum(finding.severity == "error" for finding in findings)


def codes(made: FixResult) -> list[str]:
    """What is left."""
    return [finding.code for finding, _ in made.left]


WAIT = "{state: flow.Wait, with: {duration_s: 1}, timeout: {after: 9 s, to: failed}, transitions: {done: good}}"


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("flow.Wiat", "flow.Wait"),
        ("duraton_s: 1", "duration_s: 1"),
        ("{dome: good}", "{done: good}"),
        ("{done: godo}", "{done: good}"),
    ],
)
def test_a_mistyped_name_is_written_as_it_was_meant_and_nothing_else_changes(wrong: str, right: str) -> None:
    """Comments and layout stay."""
    text = states(f"first:   {WAIT}   # as the part cools", "  # and no longer").replace(right, wrong)
    made = repaired(text)
    assert made.text == text.replace(wrong, right)
    assert (len(made.fixed), made.left) == (1, ())


def test_several_in_one_node_and_in_many_are_made_together() -> None:
    wrong = WAIT.replace("Wait", "Wiat").replace("duration", "duraton").replace("done: good", "dnoe: NEXT")
    lines = [f"s{n}: {wrong.replace('NEXT', f's{n + 1}')}" for n in range(30)]
    made = repaired(states(f"first: {wrong.replace('NEXT', 's0')}", *lines, f"s30: {WAIT}"))
    assert (made.left, made.text.count("flow.Wait"), made.text.count("duration_s")) == ((), 32, 32)


@pytest.mark.parametrize("text", [LOOSE.replace(", b: failed", "")])
def test_what_a_person_must_choose_is_left_with_the_choices(text: str) -> None:
    """Where an outcome leads, which value a parameter gets."""
    made = repaired(text)
    assert (made.text, made.fixed) == (text, ())
    titles = {finding.message: [fix.title for fix in fixes] for finding, fixes in made.left}
    assert len(titles["outcome `b` of `first` is not connected"]) > 1


def test_an_outcome_called_like_one_that_leads_out_is_connected_to_it() -> None:
    text = states("first: {state: motion.MoveJoints, with: {robot: left, target: [0.0]}, transitions: {reached: good}}")
    assert "failed: failed" in repaired(text).text


def test_the_likely_fixes_are_made_when_asked_for_and_no_node_is_deleted() -> None:
    text = states("first: {state: test.Give, transitions: {a: good, b: failed}}", f"lost: {WAIT}")
    made = repaired(text, likely=True)
    assert "lost:" in made.text
    assert codes(made) == ["unreachable-node"]


def test_a_fix_that_brings_more_errors_to_light_than_it_mends_is_not_kept() -> None:
    """With its name the state has parameters and outcomes that nobody can guess."""
    text = states("first: {state: motion.MoveJoint, transitions: {done: good}}")
    made = repaired(text)
    assert (made.text, made.fixed) == (text, ())
    assert [fix.title for finding, fixes in made.left for fix in fixes if finding.code == "unknown-state"][:1] == [
        "Run `motion.MoveJoints`"
    ]


@pytest.mark.parametrize("likely", [False, True])
@settings(deadline=None, max_examples=examples(30, nightly=240))
@given(data=st.data())
def test_a_second_time_nothing_changes_and_there_are_never_more_errors(likely: bool, data: st.DataObject) -> None:
    _, text, _ = data.draw(st.sampled_from(SLIPS))
    made = repaired(text, likely=likely)
    again = repaired(made.text, likely=likely)
    assert (again.text, again.fixed) == (made.text, ())
    assert errors(tuple(finding for finding, _ in made.left)) <= errors(findings_of(text))


@pytest.mark.parametrize(
    ("written", "meant", "known", "is_one"),
    [
        ("flow.Wiat", "flow.Wait", ("flow.Wait", "flow.Log"), True),
        ("finishd", "finished", ("finished", "failed"), True),
        ("Reached", "reached", ("reached",), True),
        ("pre-grasp", "pre_grasp", ("pre_grasp",), True),
        ("left_1", "left_2", ("left_2",), False),
        ("grsp", "grasp", ("grasp", "close"), True),
        ("gasp", "grasp", ("grasp", "clasp", "gasps"), False),
        ("found", "not_found", ("not_found",), False),
        ("unreached", "reached", ("reached",), False),
        ("on", "in", ("in",), False),
    ],
)
def test_a_slip_is_one_letter_away_from_one_name_only(
    written: str, meant: str, known: tuple[str, ...], is_one: bool
) -> None:
    assert is_typo(written, meant, known) is is_one
