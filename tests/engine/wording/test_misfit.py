"""What is wrong with a value, in the words of documents; where it is none of the choices, these are named."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.wording.misfit import Misfit, explain_misfit, place_text


class Lamp(msgspec.Struct, frozen=True):
    colour: Annotated[Literal["red", "yellow", "green"], msgspec.Meta(description="Which lamp, from the top.")]
    blinks: int | Literal["fast"] = 0


class Tower(msgspec.Struct, frozen=True):
    lamps: tuple[Lamp, ...] = ()
    by_name: dict[str, Lamp] = {}


def _explained(value: object) -> str:
    with pytest.raises(msgspec.ValidationError) as caught:
        msgspec.convert(value, Tower)
    return explain_misfit(caught.value, Tower)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ({"lamps": [{"colour": "gren"}]}, "`lamps[0].colour`: there is no choice 'gren' (did you mean green?)"),
        (
            {"lamps": [{"colour": "blue"}]},
            "`lamps[0].colour`: there is no choice 'blue' (known: green, red, yellow)",
        ),
        ({"lamps": 3}, "`lamps`: expected list, got integer"),
        ({"by_name": {"top": {"colour": 3}}}, "`by_name`: expected text, got integer"),
        ([], "expected mapping, got list"),
    ],
)
def test_a_misfit_is_explained_with_its_place_and_the_choices(value: object, text: str) -> None:
    assert _explained(value) == text


@given(st.lists(st.from_regex(r"[a-z_]{1,8}", fullmatch=True) | st.integers(0, 99), min_size=1))
def test_the_place_of_a_complaint_is_read_as_it_is_written(steps: list[str | int]) -> None:
    path = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)
    misfit = Misfit.of(f"Expected `int`, got `str` - at `${path}`")
    assert misfit.path == tuple(steps)
    assert place_text(misfit.path) == path.removeprefix(".")
