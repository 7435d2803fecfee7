"""Statistics of an adaptive motion, and the listener interface for its phases and paths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from engine.skills.planning import MotionPhase
from robots.arm.scene_queries.path_planner import PathSegment


@dataclass(kw_only=True)
class AdaptiveMotionReport:
    """Statistics of a motion so far; `blocked` is the reason if it was given up, else empty."""

    stops: int = 0
    replans: int = 0
    reused: int = 0
    blocked: str = ""


class AdaptiveMotionListener(Protocol):
    """Receives phase and path changes of a motion."""

    def entered(self, phase: MotionPhase, reason: str) -> None:
        """Report that the motion has entered another phase."""
        ...

    def follows(self, segment: PathSegment) -> None:
        """Report that the motion follows this path from now on."""
        ...
