"""Who commands: one sender at a time, until it has been silent for a while and nothing of it is in motion."""

from __future__ import annotations

from typing import Literal

from robots.reconcell.packet_errors import PacketRefused

Sender = tuple[str, int]
CommanderIdentity = Literal["socket", "host"]
"""Whether a sender is known by address and port, or by its address, for programs with a socket for each port."""


class CommanderWatch:
    """Gives the command to the first sender whose packet is valid, and refuses others by name.

    Args:
        identity: What distinguishes senders.
        release_s: Silence after which another sender may command.
    """

    def __init__(self, *, identity: CommanderIdentity, release_s: float) -> None:
        self._identity = identity
        self._release_s = release_s
        self._commander = self._last = ""
        self._heard_s = self._active_s = 0.0

    @property
    def name(self) -> str:
        """The sender that commands; empty for none."""
        return self._commander

    def admit(self, sender: Sender, *, now_s: float, in_motion: bool) -> bool:
        """Take a packet of a sender; returns whether it is another commander than the one before.

        Raises:
            PacketRefused: another sender commands.
        """
        name = sender[0] if self._identity == "host" else f"{sender[0]}:{sender[1]}"
        self.look(now_s=now_s, in_motion=in_motion)
        if self._commander not in {"", name}:
            raise PacketRefused(
                "not the commander", f"{self._commander} commands", where=name, hint="wait for its end and its silence"
            )
        changed = name != self._last
        self._commander = self._last = name
        self._heard_s = self._active_s = now_s
        return changed

    def silence_s(self, now_s: float) -> float:
        """Return how long the commander has been silent."""
        return now_s - self._heard_s

    def look(self, *, now_s: float, in_motion: bool) -> None:
        """Release the command after the silence; a motion of the commander counts as a sign of it."""
        if in_motion:
            self._active_s = now_s
        elif now_s - self._active_s >= self._release_s:
            self._commander = ""
