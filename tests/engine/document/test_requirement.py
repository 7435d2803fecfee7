"""What a sweep requires, as it is written."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.requirement import Requirement
from engine.document.sweep import SweepDocument, parse_sweep
from engine.errors import DocumentError

NAMES = st.from_regex(r"[a-z_]+(\.[a-z_0-9]+){0,3}", fullmatch=True)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
RATES = st.floats(0.0, 1.0).map(lambda rate: f"{rate:.6f}")


def _document(*required: str) -> SweepDocument:
    text = "flexcell: 1\nbehavior: b.yaml\nrequire:\n" + "".join(f"- {each}\n" for each in required)
    return parse_sweep(text, file="s.yaml").document


@given(name=NAMES, side=st.sampled_from(("<=", ">=")), limit=NUMBERS, rate=RATES, value=NUMBERS, spaces=st.booleans())
def test_a_share_of_runs_keeps_a_limit_up_to_the_limit_itself(
    name: str, side: str, limit: float, rate: str, value: float, spaces: bool
) -> None:
    written = f"share({name} {side} {limit!r}) >= {rate}"
    (required,) = _document(f"{written.replace(' ', '')!r}" if not spaces else f"{written!r}").requirements
    assert (required.text, required.rate) == (written, float(rate))
    assert required.limit is not None
    kept = value <= limit if side == "<=" else value >= limit
    for success in (True, False):
        assert required.is_kept(success=success, numbers={name: value, "other": -value}) == kept
        assert required.is_kept(success=success, numbers={name: limit})
        assert not required.is_kept(success=success, numbers={"other": limit})


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_number_that_is_none_keeps_no_limit(value: float) -> None:
    assert not Requirement.parse("share(force_n <= 30) >= 0.9").is_kept(success=True, numbers={"force_n": value})


def test_success_is_what_the_behavior_says() -> None:
    required = Requirement.parse("success>=0.98")
    assert (required.text, required.rate, required.limit) == ("success >= 0.98", 0.98, None)
    assert required.is_kept(success=True, numbers={})
    assert not required.is_kept(success=False, numbers={})


def test_several_are_required_each_once() -> None:
    document = _document("success >= 0.9", "success>=0.9", "share(a <= 1) >= 0.5", "success >= 0.95")
    texts = [each.text for each in document.requirements]
    assert texts == ["success >= 0.9", "share(a <= 1) >= 0.5", "success >= 0.95"]
    assert document.required_rate == 0.95
    assert _document("share(a <= 1) >= 0.5").required_rate is None


@pytest.mark.parametrize(
    "text",
    [
        "most cell.contact_force_max_n <= 30",
        "share(a <= 30) <= 0.95",
        "share(a < 30) >= 0.95",
        "share(a <= 30) >= 1.5",
        "share(a <= thirty) >= 0.95",
        "share(<= 30) >= 0.95",
        "share(a b <= 30) >= 0.95",
    ],
)
def test_what_cannot_be_required_is_refused_with_what_can(text: str) -> None:
    """A largest value cannot: no number of runs proves that a larger one never occurs."""
    with pytest.raises(DocumentError, match=r"s.yaml:4:3: `require`.*share\(cell.contact_force_max_n <= 30\) >= 0.95"):
        _document(f"'{text}'")


def test_nothing_in_a_list_is_no_requirement() -> None:
    with pytest.raises(DocumentError, match=r"s.yaml:3:10: `require`"):
        parse_sweep("flexcell: 1\nbehavior: b.yaml\nrequire: []\n", file="s.yaml")
