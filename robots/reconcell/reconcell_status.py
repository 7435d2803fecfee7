"""What the interface of an arm says on the bus: who commands, what was refused, by name."""

from __future__ import annotations

import logging

from engine.clock import Clock
from engine.messages import Message
from robots.reconcell.packet_errors import PacketRefused

_log = logging.getLogger("flexcell.reconcell")
_PAUSE_S = 1.0


class ReconcellStatus(Message, frozen=True, kw_only=True):
    """State of the interface; the latest value of `<arm>/reconcell`.

    `refused` counts by name; `last_refusal` is the last one in words.
    """

    commander: str
    mode: int
    received: int
    refused: dict[str, int]
    last_refusal: str = ""


class RefusalCounter:
    """Counts refusals by name and logs them, each name at most once a second.

    Args:
        arm: For the log.
        clock: The time of the log.
    """

    def __init__(self, arm: str, clock: Clock) -> None:
        self._arm = arm
        self._clock = clock
        self._logged_s: dict[str, float] = {}
        self.counts: dict[str, int] = {}
        self.last = ""

    def count(self, refusal: PacketRefused) -> None:
        """Count a refusal."""
        name = refusal.name
        self.counts[name] = self.counts.get(name, 0) + 1
        self.last = str(refusal)
        now_s = self._clock.now_s()
        if name in self._logged_s and now_s - self._logged_s[name] < _PAUSE_S:
            return
        self._logged_s[name] = now_s
        _log.warning("%s refuses (%d times): %s", self._arm, self.counts[name], refusal)
