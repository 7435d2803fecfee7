"""One thing that was looked at, and how it is."""

from __future__ import annotations

from typing import Literal

import msgspec

Condition = Literal["ok", "note", "problem"]
"""`note`: works, with less than is possible. `problem`: something that every user needs does not work."""


class Examination(msgspec.Struct, frozen=True, kw_only=True):
    """What was looked at, how it is in one line, and what to do where that is not `ok`."""

    group: str
    subject: str
    condition: Condition
    state: str
    advice: str = ""
