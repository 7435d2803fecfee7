"""Expressions: typed values, friendly numbers, errors that name the expression, and hostile input."""

from __future__ import annotations

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.expression.cel_expression import RESERVED
from engine.document.expression.expression import compile_template
from engine.errors import ExpressionError
from engine.messages import Pose

VARIABLES: dict[str, object] = {
    "speed": 0.5,
    "tries": 2,
    "count": 3,
    "name": "hca",
    "part": {"width": 0.05, "kind": "gear"},
    "xs": [1, 2.5],
    "pose": Pose(xyz=(1.0, 2.0, 3.0)),
    "pair": (1, 2),
    "huge": 10**30,
}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("${speed}", 0.5),
        ("${speed * 0.5}", 0.25),
        ("${speed * 2}", 1.0),
        ("${2 * speed}", 1.0),
        ("${count * 0.5}", 1.5),
        ("${count + 1}", 4),
        ("${count / 2}", 1),
        ("${count / 2.0}", 1.5),
        ("${1 + 0.5}", 1.5),
        ("${-count}", -3),
        ("${count - 0.5}", 2.5),
        ("${0.5 - count}", -2.5),
        ("${tries < 3}", True),
        ("${tries < 2.5}", True),
        ("${1 < 2.5}", True),
        ("${0.5 * 2 == 1}", True),
        ("${count > 1 ? 0.5 : 1}", 0.5),
        ("${1 in [1.0]}", True),
        ("${part.width > 0.04 && part.kind == 'gear'}", True),
        ("${has(part.colour)}", False),
        ("${pose.xyz[0] + 1}", 2.0),
        ("${xs.map(x, x * 2)}", [2, 5.0]),
        ("${pair[1] + 1}", 3),
        ("${ {'a': [speed, 1]} }", {"a": [0.5, 1]}),
        ("${'}' + name}", "}hca"),
        ("${'${' + name}", "${hca"),
        ("${null}", None),
        ("${true}", True),
        ("${pair}", (1, 2)),
        ("a ${name}-${count}, ${speed}, ${tries < 3}, ${xs}", "a hca-3, 0.5, true, [1,2.5]"),
        ("$${name}", "${name}"),
        ("$$ ${count}", "$$ 3"),
        ("plain", "plain"),
        ("", ""),
        (7, 7),
        (None, None),
        ({"a": ["${speed}", 1], "b": {"c": "${count}"}}, {"a": [0.5, 1], "b": {"c": 3}}),
    ],
)
def test_a_template_gives_its_typed_value(text: object, value: object) -> None:
    """A whole expression keeps its type, an embedded one becomes text, integers stay integers."""
    result = compile_template(text).evaluate(VARIABLES)
    assert (result, type(result)) == (value, type(value))


def test_a_bare_name_gives_the_very_value() -> None:
    """Nothing is converted where nothing is computed."""
    assert compile_template("${pose}").evaluate(VARIABLES) is VARIABLES["pose"]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("${speed * other.width}", {"speed", "other"}),
        ("${xs.map(x, x + y)}", {"xs", "y"}),
        ("${has(p.q)}", {"p"}),
        ("${'speed'}", set[str]()),
        ("speed", set[str]()),
        ("${a} and ${b}", {"a", "b"}),
        ([{"k": "${c}"}], {"c"}),
        ("${" + " + ".join(f"v{i}" for i in range(25)) + "}", {f"v{i}" for i in range(25)}),
    ],
)
def test_the_names_used_are_known_before_a_run(text: object, names: set[str]) -> None:
    """Only variables count: no text, no fields, no names bound by a comprehension."""
    assert compile_template(text).names == names


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("${speed *}", "Syntax error"),
        ("${}", "empty"),
        ("${speed", "not closed"),
        ("${foo(1)}", "no function `foo`"),
        ("${in}", "Syntax error"),
        ("${'a' * 2}", "no matching overload"),
        ("${" + "x" * 3000 + "}", "longer than 1000"),
        ("${" + "[" * 60 + "]" * 60 + "}", "recursion"),
        ("${speed > 0 ? 'a' : 1}", "no matching overload"),
        ("${__import__('os')}", "no function"),
        ("${name.__class__.mro()}", "no function"),
        ("${(lambda: 1)()}", "Syntax error"),
    ],
)
def test_a_malformed_expression_is_refused_before_a_run(text: str, says: str) -> None:
    """The message names the expression and the reason in one line."""
    with pytest.raises(ExpressionError) as refusal:
        compile_template(text)
    assert says in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("${nothing}", "`nothing` is not defined"),
        ("${nothing + 1}", "`nothing` is not defined"),
        ("${name * 2}", "with name = 'hca'"),
        ("${1 / 0}", "divide by zero"),
        ("${speed / 0}", "the result is inf"),
        ("${part.colour}", "Key not found"),
        ("${xs[5]}", "Index error"),
        ("${huge + 1}", "out of range"),
        ("${9223372036854775807 + 1}", "overflow"),
        ("${b'a'}", "not a document value"),
        ("${name.__class__}", "name = 'hca'"),
        ("${timestamp('2020-01-01T00:00:00Z')}", "not a document value"),
    ],
)
def test_a_failed_evaluation_names_expression_and_variables(text: str, says: str) -> None:
    """What a run cannot compute is an error of its own family."""
    template = compile_template(text)
    with pytest.raises(ExpressionError) as failure:
        template.evaluate(VARIABLES)
    assert says in str(failure.value)
    assert text in str(failure.value)


def test_an_expression_that_would_run_for_ever_is_refused_before_a_run() -> None:
    """Nested comprehensions cost too much whatever they are given."""
    text = "i"
    for name in "abcdef":
        text = f"[1,2,3,4,5,6,7,8,9,10].map({name}, {text if text != 'i' else name})"
    with pytest.raises(ExpressionError, match="steps"):
        compile_template("${" + text + "}")


@given(st.text("${}'\"\\ ab1+*.()[]<?:&|", max_size=30))
def test_any_text_compiles_or_is_refused_as_an_expression(text: str) -> None:
    """No input brings another error or a crash."""
    with contextlib.suppress(ExpressionError):
        compile_template(text).evaluate({"a": 1, "b": "x"})


@given(st.text(max_size=30).filter(lambda text: "${" not in text))
def test_text_without_expressions_is_not_reported(text: str) -> None:
    """The template is constant and gives the very value."""
    template = compile_template(text)
    assert template.constant
    assert template.evaluate({}) is text


@given(a=st.integers(-1000, 1000), b=st.floats(-1e6, 1e6))
def test_integers_and_decimals_mix_as_in_mathematics(a: int, b: float) -> None:
    """Sum, difference, product and order agree with Python's."""
    template = compile_template(
        {"sum": "${a + b}", "less": "${a < b}", "product": "${b * a}", "difference": "${a - b}"}
    )
    expected = {"sum": a + b, "less": a < b, "product": b * a, "difference": a - b}
    assert template.evaluate({"a": a, "b": b}) == expected


def test_reserved_words_are_those_that_cannot_be_variables() -> None:
    """No reserved word compiles to the value of a variable of that name."""
    for word in RESERVED:
        try:
            result = compile_template("${" + word + "}").evaluate({word: "mine"})
        except ExpressionError:
            continue
        assert result != "mine"


@pytest.mark.parametrize("value", ["a\0b", ["a\0b"], {"a\0": 1}])
def test_a_text_that_the_expression_would_read_cut_is_refused(value: object) -> None:
    template = compile_template("${size(value) > 1}")
    with pytest.raises(ExpressionError, match="contains a NUL character"):
        template.evaluate({"value": value})
    assert compile_template("${value}").evaluate({"value": value}) == value
