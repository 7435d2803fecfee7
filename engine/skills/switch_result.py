"""The answer of services that switch something: done or not, and a word about it (RCL tables 9 to 11)."""

from __future__ import annotations

from engine.messages import Message


class SwitchResult(Message, frozen=True, kw_only=True):
    """`success` is true when what was asked for is so now; `message` says what was done, or why it was not."""

    success: bool
    message: str
