"""Skills of a switchable magnet, answered under `<arm>/magnet` (IRB 4.1, 4.5)."""

from __future__ import annotations

from engine.messages import MagnetState, Message
from engine.skill import Action, Service


class MagnetFeedback(Message, frozen=True, kw_only=True):
    """How hard the magnet pulls at what touches it on the way."""

    pull_n: float


class MagnetResult(Message, frozen=True, kw_only=True):
    """What the magnet holds once its field is settled.

    `part` is what is held, `?` where the magnet cannot tell; `reason` says in words why nothing is, and
    is empty when `held`.
    """

    on: bool
    held: bool
    pull_n: float
    part: str = ""
    reason: str = ""


class MagnetSwitch(Action[MagnetResult, MagnetFeedback], frozen=True, kw_only=True):
    """Switch the magnet on or off and confirm what it holds.

    Succeeds as an action whether or not something is held; `MagnetResult.held` tells.
    """

    on: bool


class ReadMagnet(Service[MagnetState], frozen=True, kw_only=True):
    """Return the measured state of the magnet now."""
