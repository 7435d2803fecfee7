"""The response of services that switch something: success and a message (RCL tables 9 to 11)."""

from __future__ import annotations

from engine.messages import Message


class SwitchResult(Message, frozen=True, kw_only=True):
    """`success` is true when the requested state is reached; `message` is what was done, or why it was not."""

    success: bool
    message: str
