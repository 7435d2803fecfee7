"""A hand and a magnet without physics, in the time of the event loop."""

from __future__ import annotations

import asyncio

from engine.errors import RobotError
from robots.magnet.magnet_port import MagnetSample
from robots.port import HandSample, Motion
from tests.robots.fake_port import FakeMotion

SWITCH_S = 0.2


class FakeHandPort:
    """Implements `HandPort`: from `holds_from` on, the fingers touch what `contacts` says and press."""

    max_force_n = 150.0

    def __init__(
        self,
        *,
        contacts: tuple[str, ...] = ("part", "part", "part", "part", "part", "part"),
        holds_from: float = 0.5,
        force_n: float = 60.0,
    ) -> None:
        self._contacts = contacts
        self._holds_from = holds_from
        self._force_n = force_n
        self._way = (0.0, 0.0)
        self.motion: FakeMotion | None = None
        self.asked: list[tuple[float, float]] = []

    def lose_the_part(self) -> None:
        """Let what is held slip away."""
        self._holds_from = 2.0

    def sample(self) -> HandSample:
        """How far it is closed and what it touches."""
        start, goal = self._way
        closed = goal if self.motion is None else start + self.motion.progress * (goal - start)
        touching = closed >= self._holds_from
        return HandSample(
            time_s=asyncio.get_running_loop().time(),
            closed_share=closed,
            force_n=self._force_n if touching else 0.2,
            contacts=self._contacts if touching else ("",) * len(self._contacts),
        )

    def close_to(self, *, share: float, time_s: float) -> Motion:
        """Close."""
        self.asked.append((share, time_s))
        self._way = (self.sample().closed_share, share)
        self.motion = FakeMotion(time_s)
        return self.motion


class FakeMagnetPort:
    """Implements `MagnetPort`: pulls at what touches it while on."""

    max_force_n = 200.0

    def __init__(self, *, contact: str = "plate", pull_n: float = 200.0, dead: bool = False) -> None:
        self.contact = contact
        self._pull_n = pull_n
        self._dead = dead
        self._on = False
        self.motion: FakeMotion | None = None

    def sample(self) -> MagnetSample:
        """Whether it is on and what it pulls at."""
        pulls = self._on and self.contact != ""
        return MagnetSample(
            time_s=asyncio.get_running_loop().time(),
            on=self._on,
            pull_n=self._pull_n if pulls else 0.0,
            contact=self.contact,
        )

    def switch(self, *, on: bool) -> Motion:
        """Switch."""
        if self._dead:
            raise RobotError("no answer from the output", where="magnet")
        self._on = on
        self.motion = FakeMotion(SWITCH_S)
        return self.motion
