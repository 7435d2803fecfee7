"""Whoever permits motion says why, in words."""

from __future__ import annotations

import msgspec
import pytest

from engine.skills.devices import EnableDevice


@pytest.mark.parametrize("reason", ["", "ok", "     ", "\n\n\t\n", "   x "])
def test_blanks_are_no_reason(reason: str) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert({"reason": reason}, EnableDevice)


def test_a_reason_in_words_is_taken_as_it_is() -> None:
    reason = "the area is clear"
    assert msgspec.convert({"reason": reason}, EnableDevice) == EnableDevice(reason=reason)
