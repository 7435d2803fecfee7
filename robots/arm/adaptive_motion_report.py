"""What an adapting motion tells: what it took so far, what it does now, which way it goes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from engine.skills.planning import MotionPhase
from robots.arm.path_planner import PathSegment


@dataclass(kw_only=True)
class AdaptiveMotionReport:
    """What a motion took so far; `blocked` says why it was given up, if it was."""

    stops: int = 0
    replans: int = 0
    reused: int = 0
    blocked: str = ""


class AdaptiveMotionListener(Protocol):
    """Who is told what the motion does."""

    def entered(self, phase: MotionPhase, reason: str) -> None:
        """It does something else now."""
        ...

    def follows(self, leg: PathSegment) -> None:
        """It goes this way from now on."""
        ...
