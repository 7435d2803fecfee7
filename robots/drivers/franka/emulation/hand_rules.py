"""What the proxy adds to the hand of franky-sim: a hand that was switched on does not know its stroke."""

from __future__ import annotations

import struct

from robots.drivers.franka.emulation.command_link import Write

HAND_HEADER = struct.Struct("<HII")
_HOMING = 1
_STATE = struct.Struct("<IddBH")
_STROKE = struct.Struct("<d")
_STROKE_AT = 12


class HandRules:
    """Implements `LinkRules` for the hand."""

    def __init__(self, *, homed: bool) -> None:
        self.homed = homed
        self.requests = 0
        self.homings = 0

    def connected(self, *, to_robot: Write, to_client: Write) -> None:
        """Note a client, and how it and the robot are written to."""

    def disconnected(self) -> None:
        """Note that the client has gone."""

    def request(self, code: int, number: int, message: bytes) -> bool:
        """Count the requests."""
        self.requests += 1
        return True

    def reply(self, code: int, number: int, message: bytes) -> bytes:
        """Note the end of the homing."""
        if code == _HOMING:
            self.homings += 1
            self.homed = True
        return message

    def state(self, datagram: bytes) -> bytes:
        """Hide the stroke of a hand that does not know it."""
        if self.homed or len(datagram) != _STATE.size:
            return datagram
        return datagram[:_STROKE_AT] + _STROKE.pack(0.0) + datagram[_STROKE_AT + _STROKE.size :]

    def command(self) -> None:
        """Ignore it: the hand is not commanded by datagrams."""
