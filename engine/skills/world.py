"""Skills of a simulated world, answered under `cell`; a real cell does not have them."""

from __future__ import annotations

from engine.messages import Message
from engine.skill import Service


class PartsReset(Message, frozen=True, kw_only=True):
    """The parts that were put back."""

    parts: tuple[str, ...]


class ResetParts(Service[PartsReset], frozen=True, kw_only=True):
    """Put all parts back where they lay at the start, for the next trial.

    Refused while a run holds a robot or anything moves: no behavior can move parts by it.
    """
