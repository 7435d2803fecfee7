"""The registers of a 2F gripper: three words for commands, three for its status; knows no transport."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum

from robots.io.wire.link_error import LinkError

COMMAND_ADDRESS = 0x03E8
STATUS_ADDRESS = 0x07D0
WORDS = 3

_ACT, _GTO, _ATR = 0x01, 0x08, 0x10


class ActivationStatus(IntEnum):
    """gSTA."""

    RESET = 0
    ACTIVATING = 1
    UNUSED = 2
    ACTIVE = 3


class ObjectStatus(IntEnum):
    """gOBJ: what the fingers do or met."""

    MOVING = 0
    CONTACT_OPENING = 1
    CONTACT_CLOSING = 2
    AT_POSITION = 3


FAULTS: Mapping[int, str] = {
    0x0: "",
    0x5: "action delayed: the activation is not finished",
    0x7: "the activation bit is not set",
    0x8: "over-temperature: wait until the gripper has cooled down",
    0xA: "under-voltage: check the supply of the gripper",
    0xB: "automatic release in progress",
    0xC: "internal fault",
    0xD: "activation fault: check that nothing obstructs the fingers",
    0xE: "over-current",
    0xF: "automatic release completed",
}
"""gFLT by name."""
_NEEDS_RESET = 0xA
_NOT_ACTIVATED = (0x5, 0x7)


@dataclass(frozen=True, kw_only=True)
class GripperStatus:
    """The status words; `position` and `position_echo` are counts, 0 open to 255 closed."""

    activated: bool
    go: bool
    activation: ActivationStatus
    contact: ObjectStatus
    fault: int
    position_echo: int
    position: int
    current_a: float

    @property
    def active(self) -> bool:
        """Whether it is activated and accepts motions."""
        return self.activated and self.activation is ActivationStatus.ACTIVE

    @property
    def fault_name(self) -> str:
        """Its fault in words; empty without one, and while it is only not activated."""
        if self.fault in _NOT_ACTIVATED:
            return ""
        return FAULTS.get(self.fault, f"unknown fault 0x{self.fault:X}")

    @property
    def needs_reset(self) -> bool:
        """Whether only a reset clears the fault."""
        return self.fault >= _NEEDS_RESET


@dataclass(frozen=True, kw_only=True)
class GripperCommand:
    """The command words: `go` moves to `position`; without `activate` the gripper is reset."""

    activate: bool
    go: bool = False
    release: bool = False
    position: int = 0
    speed: int = 0
    force: int = 0


RESET = GripperCommand(activate=False)
ACTIVATE = GripperCommand(activate=True)


def encode_command(command: GripperCommand) -> list[int]:
    """Return the three words of a command.

    Raises:
        ValueError: position, speed or force is not a byte.
    """
    for value in (command.position, command.speed, command.force):
        if not 0 <= value <= 0xFF:
            raise ValueError(f"{value} is not a byte")
    action = (_ACT if command.activate else 0) | (_GTO if command.go else 0) | (_ATR if command.release else 0)
    return [action << 8, command.position, command.speed << 8 | command.force]


def decode_command(words: Sequence[int]) -> GripperCommand:
    """Return the command in three words; the counterpart of `encode_command` for emulators and captures."""
    action, position, rates = _words(words)
    return GripperCommand(
        activate=bool(action >> 8 & _ACT),
        go=bool(action >> 8 & _GTO),
        release=bool(action >> 8 & _ATR),
        position=position & 0xFF,
        speed=rates >> 8,
        force=rates & 0xFF,
    )


def encode_status(status: GripperStatus) -> list[int]:
    """Return the three words of a status."""
    action = (
        (_ACT if status.activated else 0)
        | (_GTO if status.go else 0)
        | int(status.activation) << 4
        | int(status.contact) << 6
    )
    current = min(0xFF, max(0, round(status.current_a * 100.0)))
    return [action << 8, (status.fault & 0xFF) << 8 | status.position_echo, status.position << 8 | current]


def decode_status(words: Sequence[int]) -> GripperStatus:
    """Return the status in three words.

    Raises:
        LinkError: they are not three words, or have a state that no gripper of this family has.
    """
    action, faults, measured = _words(words)
    high = action >> 8
    activation = ActivationStatus(high >> 4 & 0x3)
    if activation is ActivationStatus.UNUSED:
        raise LinkError(f"the status word 0x{action:04X} is not that of a 2F gripper")
    return GripperStatus(
        activated=bool(high & _ACT),
        go=bool(high & _GTO),
        activation=activation,
        contact=ObjectStatus(high >> 6 & 0x3),
        fault=faults >> 8 & 0xF,
        position_echo=faults & 0xFF,
        position=measured >> 8,
        current_a=(measured & 0xFF) / 100.0,
    )


def _words(words: Sequence[int]) -> tuple[int, int, int]:
    if len(words) != WORDS or not all(0 <= word <= 0xFFFF for word in words):
        raise LinkError(f"expected {WORDS} registers, got {list(words)[:8]}")
    first, second, third = words
    return first, second, third
