"""The options of the interface."""

from __future__ import annotations

from dataclasses import dataclass

from robots.reconcell.commander import CommanderIdentity
from robots.reconcell.quaternion_order import QuaternionOrder


@dataclass(frozen=True, kw_only=True)
class InterfaceOptions:
    """How the interface of an arm is served.

    Attributes:
        address: IPv4 loopback address of the command ports.
        receivers: IPv4 addresses to which the state is sent.
        rate_hz: Rate of the state packets.
        quaternion: Order of quaternions on the wire.
        commander: What distinguishes senders.
        release_s: Silence after which another sender may command and direct control ends.
        watchdog_s: Longest time between two set points of direct control; then the arm comes to rest.
        silence_s: Longest silence of the commander during any motion; 0 lets a motion that was started go on.
        capture: Folder to which all datagrams are captured; empty for none.
    """

    address: str = "127.0.0.1"
    receivers: tuple[str, ...] = ("127.0.0.1",)
    rate_hz: float = 125.0
    quaternion: QuaternionOrder = "xyzw"
    commander: CommanderIdentity = "socket"
    release_s: float = 1.0
    watchdog_s: float = 0.1
    silence_s: float = 0.0
    capture: str = ""
