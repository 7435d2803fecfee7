"""What an expression may cost is known before it runs: hostile ones are refused, others are not."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import cast

import pytest

from benchmarks.hostile_expressions import hostile_data, hostile_text
from engine.document.expression.cel_environment import environment
from engine.document.expression.cel_expression import MAX_TEXT
from engine.document.expression.expression import MAX_PER_TEXT, MAX_PER_VALUE, compile_template
from engine.document.expression.expression_cost import MAX_STEPS
from engine.document.expression.step_meter import METER
from engine.errors import ExpressionError

NUMBERS = list(range(1_000))


def steps(text: str, variables: Mapping[str, object]) -> float:
    """Return what an evaluation was counted as."""
    before = METER.spent
    compile_template(text).evaluate(variables)
    return METER.spent - before


@pytest.mark.parametrize(
    ("text", "variables"),
    [
        ("${xs.exists(i, -1 in xs)}", {"xs": NUMBERS}),
        ("${xs.map(i, xs.map(j, i + j))}", {"xs": NUMBERS[:200]}),
        ("${xs.map(i, i)}", {"xs": NUMBERS}),
        ("${xs.filter(i, xs == ys)}", {"xs": NUMBERS, "ys": NUMBERS}),
        ("${[s]" + ".map(a, a + a)" * 20 + "}", {"s": "x" * 1_000}),
        ("${[xs]" + ".map(a, a + a)" * 20 + "}", {"xs": NUMBERS[:100]}),
        ("${[xs]" + ".map(a, [a, a])" * 25 + "}", {"xs": [1]}),
        ("${s.contains(s + 'x')}", {"s": "a" * 50_000}),
        ("${s.matches('.{900}.{900}')}", {"s": "x"}),
        ("${s.matches('((a{30}){30})')}", {"s": "a" * 1_000}),
        ("${s.matches('[a\\\\pL]{50}x')}", {"s": "a" * 100}),
        ("${size(xs)}", {"xs": [NUMBERS] * 1_000}),
        ("${size(s)}", {"s": "x" * 10_000_000}),
        ("a ${xs} b", {"xs": [NUMBERS] * 1_000}),
    ],
)
def test_what_may_take_too_long_with_these_values_is_refused(text: str, variables: Mapping[str, object]) -> None:
    """Nested searches, nested and chained maps, doubling, patterns, and plainly large values."""
    with pytest.raises(ExpressionError, match=r"steps|contains more than") as refusal:
        compile_template(text).evaluate(variables)
    assert "state" in str(refusal.value)


@pytest.mark.parametrize(
    "text",
    [
        "${" + "[1,2,3,4,5,6,7,8,9]" + ".map(a, [a, a, a])" * 20 + "}",
        "${'x'" + ".matches('\\\\pL{900}') && 'x'" * 3 + ".matches('y')}",
        "${" + "[1,2,3,4,5,6,7,8].exists(a, " * 6 + "false" + ")" * 6 + "}",
    ],
)
def test_what_takes_too_long_with_any_values_is_refused_by_the_check(text: str) -> None:
    """It does not even compile."""
    with pytest.raises(ExpressionError, match="steps"):
        compile_template(text)


@pytest.mark.parametrize(
    ("text", "variables"),
    [
        ("${poses.map(p, p.xyz[0])}", {"poses": [{"xyz": [1.0, 2.0, 3.0], "name": "a"}] * 100}),
        ("${xs.filter(x, x > 3)}", {"xs": NUMBERS[:250]}),
        ("${name in names}", {"name": "x", "names": ["abc"] * 1_000}),
        (
            "${parts.exists(p, p.kind == kind && p.width < 0.05)}",
            {"parts": [{"kind": "gear", "width": 1}] * 500, "kind": "x"},
        ),
        ("${rows.map(r, r.map(c, c * 2.0))}", {"rows": [[1.0] * 10] * 10}),
        ("${" + "[1].map(x, true, " * 14 + "1" + ")" * 14 + "}", {}),
        ("${name.matches('^[a-z]+_[0-9]{1,4}$')}", {"name": "part_12"}),
        ("${name.matches(pattern)}", {"name": "part_12", "pattern": "part_[0-9]+"}),
        ("${text + text}", {"text": "x" * 40_000}),
        ("${size(points)}", {"points": [0.5] * 5_000}),
        ("${timestamp('2026-01-01T00:00:00Z').getHours('Europe/Berlin')}", {}),
    ],
)
def test_ordinary_expressions_are_evaluated(text: str, variables: Mapping[str, object]) -> None:
    """The bounds leave room for what behaviors do."""
    assert steps(text, variables) <= MAX_STEPS


@pytest.mark.parametrize(
    ("text", "variables"),
    [
        ("${google.protobuf.Struct{}}", {}),
        ("${names.exists(n, s.matches(n))}", {"s": "x", "names": ["a", "b"]}),
        ("${timestamp('2026-01-01T00:00:00Z').getHours('/dev/zero')}", {}),
        ("${timestamp('2026-01-01T00:00:00Z').getHours(zone)}", {"zone": "../../etc/localtime"}),
        ("${size(x)}", {"x": object()}),
        ("a ${x}", {"x": object()}),
        ("${__flexcell_anything_0 + a}", {"a": 1}),
    ],
)
def test_what_nobody_knows_the_cost_of_is_refused(text: str, variables: Mapping[str, object]) -> None:
    """Messages, patterns that are put together, files named as time zones, values of no document."""
    with pytest.raises(ExpressionError):
        compile_template(text).evaluate(variables)


def test_a_text_or_value_holds_a_bounded_number_of_expressions() -> None:
    """Two thousand expressions with names of their own took 1.9 GB."""
    with pytest.raises(ExpressionError, match=str(MAX_PER_TEXT)):
        compile_template("".join(f"${{a{number} + 1}}" for number in range(2_000)))
    with pytest.raises(ExpressionError, match=str(MAX_PER_VALUE)):
        compile_template([f"${{a{number} + 1}}" for number in range(2_000)])


def test_the_expressions_of_a_value_share_one_allowance() -> None:
    """Each of them alone would pass."""
    xs = NUMBERS[:250]
    assert steps("${xs.map(x, x)}", {"xs": xs}) < MAX_STEPS
    with pytest.raises(ExpressionError, match="steps"):
        compile_template(["${xs.map(x, x)}"] * 5).evaluate({"xs": xs})


def test_text_does_not_grow_without_end() -> None:
    """A value that is doubled in a loop ends with an error that says which value it is."""
    double = compile_template({"text": "${text + text}"})
    text: object = "x" * 40_000
    grown = double.evaluate({"text": text})
    with pytest.raises(ExpressionError, match=f"`text`: .*{MAX_TEXT:,}"):
        double.evaluate(cast("dict[str, object]", grown))
    with pytest.raises(ExpressionError, match=f"{MAX_TEXT:,}"):
        compile_template("${text}${text}").evaluate({"text": "x" * 60_000})


def test_a_bare_name_hands_on_a_value_of_any_size() -> None:
    """It is not looked into."""
    image = [NUMBERS] * 1_000
    assert compile_template({"image": "${image}"}).evaluate({"image": image}) == {"image": image}


def test_the_expressions_of_one_purpose_can_be_limited_together() -> None:
    """So that a thousand cheap ones in a row are not free."""
    template = compile_template("${xs.map(x, x)}")
    variables = {"xs": NUMBERS[:250]}
    with METER.limited(MAX_STEPS, "one tick"):
        template.evaluate(variables)
        with pytest.raises(ExpressionError, match="of one tick"):
            template.evaluate(variables)
    assert template.evaluate(variables) == variables["xs"]


def test_hostile_expressions_are_refused_or_end_as_expressions_do() -> None:
    """No other error, and nothing is evaluated that was not admitted; seeded."""
    chance = random.Random(14)
    ended = [_end(hostile_text(chance), hostile_data(chance)) for _ in range(300)]
    assert max(counted for counted, _ in ended) <= MAX_STEPS
    assert not [error for _, error in ended if "\n" in error]
    assert sum(error == "" for _, error in ended) > 10


def _end(text: str, variables: Mapping[str, object]) -> tuple[float, str]:
    """Return what was counted for an evaluation, and how it failed if it did."""
    before = METER.spent
    try:
        compile_template(text).evaluate(variables)
    except ExpressionError as error:
        return METER.spent - before, str(error)
    return METER.spent - before, ""


def test_any_set_of_names_is_compiled_in_the_one_environment() -> None:
    """An environment for each took 150 kB."""
    before = environment()
    for number in range(200):
        compile_template(f"${{name_{number} + other_{number % 7}}}")
    assert environment() is before
