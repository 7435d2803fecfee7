"""A line that is no YAML hides neither the others nor what the check finds around it."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.check import check_survey
from engine.document import survey_behavior
from engine.document.text.text_recovery import recover_text
from tests.engine.document.test_partial_behavior import HEAD, KINDS, behavior_of, lines_of
from tests.engine.fake_states import CATALOGUE
from tests.tiers import examples

FIRST = HEAD.count("\n") + 1
SLIPS: tuple[Callable[[str], str], ...] = (
    lambda node: node[:-1],
    lambda node: f"{node}}}",
    lambda node: node.replace("transitions: {", "description: ${x}, transitions: {"),
    lambda node: node.replace("transitions:", "description: *x, transitions:"),
    lambda node: node.replace("transitions:", "description: &x y, transitions:"),
    lambda node: node.replace("transitions:", "description: .inf, transitions:"),
    lambda node: node.replace("transitions:", "transitions: {}, transitions:"),
    lambda _: "{state: test.Give, description: 'x}",
    lambda _: "a: b",
    lambda _: "@",
)


@settings(deadline=None)
@given(st.data())
def test_each_line_that_cannot_be_read_is_reported_and_nothing_follows_from_it(data: st.DataObject) -> None:
    """What is wrong may only show on the next line."""
    nodes = data.draw(st.lists(st.sampled_from(KINDS), min_size=1, max_size=6))
    wrong = data.draw(st.sets(st.integers(0, len(nodes) - 1), min_size=1))
    made = {number: data.draw(st.sampled_from(SLIPS)) for number in wrong}
    text = behavior_of([made[number](node) if number in made else node for number, node in enumerate(nodes)])
    survey = survey_behavior(Path("x.yaml"), text)
    lines = lines_of(survey.mistakes)
    assert len(lines) == len(wrong)
    assert survey.behavior is not None
    findings = check_survey(survey, Path("x.yaml"), CATALOGUE)
    assert [str(each) for each in findings if each.code != "invalid-document"] == []


def test_what_else_is_wrong_is_reported() -> None:
    """With the structural mistakes, in the order of the file."""
    text = behavior_of(
        [
            "{state: test.Give, transitions: {a: NEXT, b: bad, c: bad}",
            "{state: test.Give, with: {outcom: a}, transitions: {a: NEXT, b: bad, c: bad}}",
            "{state: test.Give, tims: 3, transitions: {a: NEXT, b: bad, c: bad}}",
        ]
    )
    findings = check_survey(survey_behavior(Path("x.yaml"), text), Path("x.yaml"), CATALOGUE)
    assert [(each.position.line, each.code) for each in findings] == [
        (FIRST + 1, "invalid-document"),
        (FIRST + 1, "unknown-parameter"),
        (FIRST + 2, "invalid-document"),
    ]


def test_a_block_goes_with_its_line() -> None:
    """What is indented below a repeated key is no part of the rest."""
    text = HEAD + "      s0:\n        state: test.Give\n        transitions: {a: good, b: bad, c: bad}\n"
    torn = text.replace(
        "        transitions",
        "        with:\n          outcome: a\n        with:\n          outcome: b\n        transitions",
    )
    recovered = recover_text(torn, file="x.yaml")
    assert [each.message for each in recovered.mistakes] == ["the key `with` is repeated; it first occurs on line 13"]
    assert recovered.gaps == (("root", "machine", "states", "s0"),)
    survey = survey_behavior(Path("x.yaml"), torn)
    assert lines_of(survey.mistakes) == [15]


@pytest.mark.parametrize(
    "text", ["a: [", "{", "&a [1]", "a: *b\n", "'", "- 1\n  b: 2\n", "%YAML 1.1\n---\na: 1\n", "", "{\n\n"]
)
def test_where_nothing_is_left_the_mistakes_are_all_there_is(text: str) -> None:
    survey = survey_behavior(Path("x.yaml"), text)
    assert survey.mistakes
    check_survey(survey, Path("x.yaml"), CATALOGUE)


@settings(deadline=None, max_examples=examples(80, nightly=400))
@given(st.text(st.sampled_from("ab:-{}[]'\"*&!|>#%@ \n\t,?0")), st.integers(0, 400))
def test_any_text_put_anywhere_is_reported_and_never_raises(text: str, at: int) -> None:
    whole = behavior_of(list(KINDS))
    place = min(at, len(whole))
    survey = survey_behavior(Path("x.yaml"), whole[:place] + text + whole[place:])
    check_survey(survey, Path("x.yaml"), CATALOGUE)


@pytest.mark.parametrize(
    "line", ["      s{}: {{\n", "      s{}: *a\n", "      s: {}\n", "      s{}: 'x\n", "      s{}: a: b\n"]
)
@pytest.mark.parametrize("count", [1_000, 60_000])
def test_a_text_that_is_wrong_everywhere_is_bounded(line: str, count: int) -> None:
    text = HEAD + "".join(line.format(number) for number in range(count))
    began_s = time.process_time()
    survey = survey_behavior(Path("x.yaml"), text)
    assert survey.mistakes
    assert time.process_time() - began_s < 10.0
