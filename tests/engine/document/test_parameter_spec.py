"""Parameters of behaviors: types, limits, defaults, and the form's schema."""

from __future__ import annotations

import pytest

from engine.document import ParameterSpec, bind_parameters
from engine.errors import DocumentError

SPEED = ParameterSpec(
    type="number", default=0.5, minimum=0.0, maximum=1.0, unit="m/s", label="Speed", description="How fast"
)
MODE = ParameterSpec(type="string", choices=("fast", "slow"))
PARAMETERS = {"speed": SPEED, "mode": MODE}


def test_given_values_and_defaults_make_a_full_set() -> None:
    """A number given as an integer is a float for the run."""
    assert bind_parameters(PARAMETERS, {"mode": "fast"}) == {"speed": 0.5, "mode": "fast"}
    bound = bind_parameters(PARAMETERS, {"mode": "slow", "speed": 1})
    assert (bound, type(bound["speed"])) == ({"speed": 1.0, "mode": "slow"}, float)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({}, "the parameter `mode` is missing"),
        ({"mode": "fast", "sped": 1}, "there is no parameter `sped` (did you mean speed?)"),
        ({"mode": "fast", "speed": 2}, "2 is above the maximum 1 m/s"),
        ({"mode": "fast", "speed": -1.0}, "-1.0 is below the minimum 0 m/s"),
        ({"mode": "fast", "speed": "0.5"}, "'0.5' is not a number"),
        ({"mode": "fast", "speed": True}, "True is not a number"),
        ({"mode": "warp"}, "'warp' is none of 'fast', 'slow'"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(given: dict[str, object], says: str) -> None:
    """The message names the parameter, the value and the limit."""
    with pytest.raises(DocumentError) as refusal:
        bind_parameters(PARAMETERS, given, where="transfer")
    assert says in str(refusal.value)
    assert str(refusal.value).startswith("transfer: ")


@pytest.mark.parametrize(
    ("kind", "good", "bad"),
    [
        ("integer", 3, 3.5),
        ("boolean", False, 0),
        ("string", "a", 1),
        ("joints", [0.1, 2], [0.1, "x"]),
        ("pose", {"xyz": [0, 0, 1]}, {"xyz": [0, 0]}),
        ("list", [1, "a"], {}),
        ("mapping", {"a": 1}, []),
        ("number", 2, None),
    ],
)
def test_every_type_takes_its_values_only(kind: str, good: object, bad: object) -> None:
    """Types are not converted into one another."""
    parameter = ParameterSpec(type=kind)  # pyright: ignore[reportArgumentType] - the cases are the literals
    assert parameter.problem(good) is None
    assert parameter.problem(bad) is not None


@pytest.mark.parametrize(
    ("kind", "text", "value"),
    [("number", "0.5", 0.5), ("string", "0.5", "0.5"), ("boolean", "true", True), ("joints", "[1, 2]", [1, 2])],
)
def test_command_line_text_has_the_type_of_the_parameter(kind: str, text: str, value: object) -> None:
    """Text is text for a string and JSON for all else."""
    assert ParameterSpec(type=kind).from_text(text) == value  # pyright: ignore[reportArgumentType] - the cases are the literals


def test_command_line_text_that_is_no_value_is_refused() -> None:
    """The message shows what was typed."""
    with pytest.raises(DocumentError, match="'fast' is not a number"):
        SPEED.from_text("fast")


def test_the_form_gets_a_json_schema() -> None:
    """Limits, unit, label and default stand where forms look for them."""
    assert SPEED.json_schema() == {
        "type": "number",
        "minimum": 0.0,
        "maximum": 1.0,
        "default": 0.5,
        "title": "Speed",
        "description": "How fast",
        "unit": "m/s",
    }
    assert MODE.json_schema() == {"type": "string", "enum": ["fast", "slow"]}
