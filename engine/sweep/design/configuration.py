"""One run of a sweep: its number, its seed, and the value of each factor."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import sha256

import msgspec


class Configuration(msgspec.Struct, frozen=True, kw_only=True):
    """What is different in one run of a sweep; the rest is what all its runs have in common."""

    number: int
    """From 0; the order in which results are looked at."""
    seed: int
    """The seed of the run, and of the placement of its parts."""
    values: Mapping[str, object]
    """The value of each factor by its address."""

    def key(self, subject: str) -> str:
        """Return the hash by which its result is found again.

        The number is not part of it: another design may contain the same run.

        Args:
            subject: The hash of what all runs of the sweep have in common.
        """
        content = {"subject": subject, "seed": self.seed, "values": dict(self.values)}
        return sha256(msgspec.json.encode(content, order="deterministic")).hexdigest()[:32]
