"""What the nodes of one run share: time, bus, recorder, random numbers, counters."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

from engine.bus import SkillBus
from engine.clock import Clock
from engine.recorder import Recorder
from engine.skill_port import SkillPort


@dataclass(kw_only=True)
class Execution:
    """One execution of one behavior, as its nodes see it; owned by the run, used on the loop thread."""

    run: str
    bus: SkillBus
    clock: Clock
    recorder: Recorder
    random: random.Random
    skills: SkillPort
    instant_limit: int = 10_000
    """Transitions in a row in which nothing is waited for, before a loop is reported."""
    waits: int = 0
    """How often a state has waited for something; unchanged means that no time passed."""
    visits: dict[str, int] = field(default_factory=dict[str, int])

    def visit(self, path: str) -> int:
        """Count an activation of `path` and return which one it is, from 1."""
        visit = self.visits.get(path, 0) + 1
        self.visits[path] = visit
        return visit
