"""The text protocol of the URCap's server: `SET ACT 1 GTO 1` → `ack`, `GET POS` → `POS 3`; knows no socket."""

from __future__ import annotations

from collections.abc import Mapping

from robots.drivers.robotiq.gripper_registers import ActivationStatus, GripperCommand, GripperStatus, ObjectStatus
from robots.io.wire.link_error import LinkError

ACKNOWLEDGED = b"ack"
NOT_UNDERSTOOD = b"?"
STATUS_NAMES = ("ACT", "GTO", "STA", "OBJ", "FLT", "PRE", "POS", "COU")
WRITABLE = ("ACT", "GTO", "ATR", "ARD", "FOR", "SPE", "POS")
_LONGEST_REPLY = 16


def encode_set(command: GripperCommand) -> bytes:
    """Return the line that sets all variables of a command."""
    values = {
        "ACT": int(command.activate),
        "GTO": int(command.go),
        "ATR": int(command.release),
        "SPE": command.speed,
        "FOR": command.force,
        "POS": command.position,
    }
    return f"SET {' '.join(f'{name} {value}' for name, value in values.items())}\n".encode()


def encode_get(name: str) -> bytes:
    """Return the line that asks for a variable."""
    return f"GET {name}\n".encode()


def decode_reply(name: str, line: bytes) -> int:
    """Return the value in a reply, which repeats the name of its variable.

    Raises:
        LinkError: it is the reply of another variable, or none.
    """
    words = line[:_LONGEST_REPLY].decode("ascii", errors="replace").split()
    if len(line) > _LONGEST_REPLY or len(words) != 2 or words[0] != name or not words[1].isdecimal():
        raise LinkError(f"GET {name} was answered with {bytes(line[:_LONGEST_REPLY])!r}")
    value = int(words[1])
    if value > 0xFF:
        raise LinkError(f"{name} is {value}, which is no byte")
    return value


def status_of(values: Mapping[str, int]) -> GripperStatus:
    """Return the status in the values of `STATUS_NAMES`.

    Raises:
        LinkError: a value is not one of a 2F gripper.
    """
    try:
        return GripperStatus(
            activated=bool(values["ACT"]),
            go=bool(values["GTO"]),
            activation=ActivationStatus(values["STA"]),
            contact=ObjectStatus(values["OBJ"]),
            fault=values["FLT"] & 0xF,
            position_echo=values["PRE"],
            position=values["POS"],
            current_a=values["COU"] / 100.0,
        )
    except ValueError as error:
        raise LinkError(f"the values {dict(values)} are not those of a 2F gripper: {error}") from error
