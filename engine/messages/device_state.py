"""The state of a real device, as its driver knows it."""

from __future__ import annotations

from engine.messages.geometry import Message


class DeviceState(Message, frozen=True, kw_only=True):
    """Whether a real device answers and may move; the latest value of `<device>/device`.

    `problem` is why it does not answer or may not move, empty when `enabled`. `fault` is its own fault by name.
    """

    driver: str
    address: str
    connected: bool
    enabled: bool
    problem: str = ""
    fault: str = ""
