"""What joins the parts of a cell, and what has parted them."""

from __future__ import annotations

from typing import Literal

from engine.messages.geometry import Message

BONDS_TOPIC = "cell/bonds"
"""The topic with the latest `CellBonds`."""


class BondState(Message, frozen=True, kw_only=True):
    """One bond: the part and what it is joined to, or was.

    `broken_by` is empty while it joins them. `force_n`, and `torque_nm` about its place, are what it carries.
    """

    kind: str
    part: str
    to: str
    broken_by: Literal["", "force", "torque", "cut"] = ""
    force_n: float = 0.0
    torque_nm: float = 0.0


class CellBonds(Message, frozen=True, kw_only=True):
    """All bonds of a cell by name, those of modules that are not plugged too."""

    time_s: float
    bonds: dict[str, BondState]
