"""The state of a real device, as its driver knows it, and the quality of the connection to it."""

from __future__ import annotations

from typing import Literal

from engine.messages.geometry import Message

DeviceMode = Literal["reading", "enabled", "stopped", "fault", "lost"]
"""`reading`: it is read and was not enabled yet. `stopped`: what was enabled may not move any more."""


class DeviceState(Message, frozen=True, kw_only=True):
    """Whether a real device answers and may move; the latest value of `<device>/device`.

    Attributes:
        driver: Its driver.
        address: Where it is connected.
        connected: Whether it answers.
        enabled: Whether it may move.
        problem: Why it does not answer or may not move, empty when `enabled`.
        fault: Its own fault by name.
        mode: All of this in one word.
        firmware: What it says of its firmware; empty if it says nothing.
        safety: Why its controller does not move, by name; `normal` while it can, empty where it does not say.
        last_cause: Why it was stopped or lost last; stays after it was enabled again.
        last_cause_unix_s: When that was; 0 for never.
        enabled_by: Who has enabled it last, as the person calls themselves.
        enabled_for: The reason that was given.
    """

    driver: str
    address: str
    connected: bool
    enabled: bool
    problem: str = ""
    fault: str = ""
    mode: DeviceMode = "reading"
    firmware: str = ""
    safety: str = ""
    last_cause: str = ""
    last_cause_unix_s: float = 0.0
    enabled_by: str = ""
    enabled_for: str = ""


class DeviceLink(Message, frozen=True, kw_only=True):
    """How fresh the readings of a real device are; the latest value of `<device>/link`.

    `readings_hz` and `longest_gap_s` are those of the last half second, `age_s` is the age of the last reading.
    `speed_scaling` is the share of the commanded speed that the controller permits, None where it does not say.
    """

    readings_hz: float
    longest_gap_s: float
    age_s: float
    speed_scaling: float | None = None
