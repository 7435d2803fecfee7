"""Messages and skills of a switchable magnet, served under `<arm>/magnet` (IRB 4.1, 4.5)."""

from __future__ import annotations

from msgspec import UNSET, UnsetType

from engine.messages import HoldEvidence, Message
from engine.skill import Action, Service


class MagnetState(Message, frozen=True, kw_only=True):
    """Measured state of a switchable magnet with the pull on the part at its face."""

    time_s: float
    on: bool
    pull_n: float
    held: bool
    part: str = ""
    """Name of the held part, `?` when unknown, empty for none."""
    by: HoldEvidence | UnsetType = UNSET


class MagnetFeedback(Message, frozen=True, kw_only=True):
    """The pull on the touching part while the field changes."""

    pull_n: float


class MagnetResult(Message, frozen=True, kw_only=True):
    """Whether the magnet holds a part when its field has settled.

    `part` is the name of the held part, `?` when unknown, and `by` what tells it; `reason` is why nothing is
    held, and is empty when `held`.
    """

    on: bool
    held: bool
    pull_n: float
    part: str = ""
    reason: str = ""
    by: HoldEvidence | UnsetType = UNSET


class MagnetSwitch(Action[MagnetResult, MagnetFeedback], frozen=True, kw_only=True):
    """Switch the magnet on or off and report the held part.

    Succeeds as an action whether or not a part is held, see `MagnetResult.held`.
    """

    on: bool


class ReadMagnet(Service[MagnetState], frozen=True, kw_only=True):
    """Return the measured state of the magnet."""
