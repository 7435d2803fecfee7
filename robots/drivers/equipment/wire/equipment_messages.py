"""The messages between an equipment server and its clients; each request has one answer with the same number.

Any message of the client that controls is a sign of life. Times are in seconds.
"""

from __future__ import annotations

import msgspec


class EquipmentMessage(msgspec.Struct, frozen=True, kw_only=True, tag=True, forbid_unknown_fields=True):
    """Base of the messages."""


class Greet(EquipmentMessage, frozen=True, kw_only=True):
    """The first message: who asks, and whether it wants to control."""

    name: str
    control: bool = False


class ReadPins(EquipmentMessage, frozen=True, kw_only=True):
    """Ask for `PinsState`."""


class SetPins(EquipmentMessage, frozen=True, kw_only=True):
    """Set outputs by the names of their pins; answered when they are read back."""

    values: dict[str, bool | float]


class StopPins(EquipmentMessage, frozen=True, kw_only=True):
    """STOP: outputs with `at_stop: safe` go to their safe values, the others keep theirs. Needs no control."""


class ReadConfiguration(EquipmentMessage, frozen=True, kw_only=True):
    """Ask for the `ConfigurationText` in effect."""


class ReadTemplate(EquipmentMessage, frozen=True, kw_only=True):
    """Ask for a commented example for the hardware, as `ConfigurationText`."""


class SetConfiguration(EquipmentMessage, frozen=True, kw_only=True):
    """Replace the configuration whose digest is `base`; outputs go to their safe values."""

    text: str
    base: str


class RollBack(EquipmentMessage, frozen=True, kw_only=True):
    """Take back the last change of the configuration whose digest is `base`."""

    base: str


class Restart(EquipmentMessage, frozen=True, kw_only=True):
    """Read the file anew; outputs go to their safe values."""


EquipmentRequest = (
    Greet | ReadPins | SetPins | StopPins | ReadConfiguration | ReadTemplate | SetConfiguration | RollBack | Restart
)


class PinsState(EquipmentMessage, frozen=True, kw_only=True):
    """All pins: outputs as read back, inputs as measured; `values` is empty while `problem` says why."""

    equipment: str
    sequence: int
    values: dict[str, bool | float]
    kinds: dict[str, str]
    age_s: float
    controller: str = ""
    problem: str = ""


class ConfigurationText(EquipmentMessage, frozen=True, kw_only=True):
    """A configuration: its text, its digest, and the times (UTC) at which earlier ones were replaced."""

    text: str
    digest: str
    kept: tuple[str, ...] = ()


class Done(EquipmentMessage, frozen=True, kw_only=True):
    """The request was executed."""

    message: str = ""


class EquipmentRefusal(EquipmentMessage, frozen=True, kw_only=True):
    """The request was not executed; says why and what to do."""

    reason: str
    hint: str = ""


EquipmentAnswer = PinsState | ConfigurationText | Done | EquipmentRefusal
