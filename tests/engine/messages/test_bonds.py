"""The state of a bond, as behaviors read it."""

from __future__ import annotations

import msgspec

from engine.messages.bonds import BondState


def test_a_condition_finds_that_nothing_has_parted_a_bond() -> None:
    """Also where it is the default: `message.bonds.plus.broken_by == ''`."""
    plain = msgspec.to_builtins(BondState(kind="solder", part="battery", to="board"))
    assert (plain["broken_by"], plain["force_n"], plain["torque_nm"]) == ("", 0.0, 0.0)
