"""A guard of paths whose answers a test gives, and the workspace and the reservation that go with it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import cast

import numpy as np

from engine.errors import FlexcellError
from robots.arm.execution.lookahead_path import PathReservation
from robots.arm.scene_queries.path_guard import PathGuard, PathRules
from robots.planning.request import PathCheck
from robots.planning.scene.planning_scene import NamePair
from robots.port import JointTrajectory
from robots.workspace.workspace import Workspace

FREE = PathCheck(blocked_at_s=None, pairs=(), looked_s=9.0)
WALL: NamePair = ("left/hand", "wall")
OTHER_ARM: NamePair = ("left/hand", "right/hand")


def blocked(at_s: float, *pairs: NamePair) -> PathCheck:
    """Return the answer that a path is blocked from an instant on."""
    return PathCheck(blocked_at_s=at_s, pairs=pairs or (WALL,), looked_s=at_s)


def line(*, duration_s: float = 4.0, speed_rad_s: float = 0.5, start_rad: float = 0.0) -> JointTrajectory:
    """Return a path of one joint at a constant speed, rad and rad/s."""
    times_s = np.linspace(0.0, duration_s, round(duration_s / 0.01) + 1)
    return JointTrajectory(
        dt_s=0.01,
        position_rad=start_rad + times_s[:, None] * speed_rad_s,
        velocity_rad_s=np.full((len(times_s), 1), speed_rad_s),
    )


class FakeGuard:
    """Answers as it is told; `asked_s` has the instants of the paths from which it was asked."""

    arm = "left"

    def __init__(self) -> None:
        self.answer: PathCheck | FlexcellError | ValueError = FREE
        self.takes_s = 0.0
        self.asked_s: list[float] = []
        self.rules: list[PathRules] = []
        self.paths: list[JointTrajectory] = []
        self.reserved: list[float | None] = []
        self.renewed: list[JointTrajectory] = []
        self.unobserved_reason = ""
        self.required = 0
        self._watchers: list[Callable[[frozenset[str]], None]] = []

    @property
    def guard(self) -> PathGuard:
        """Itself, as what it stands for."""
        return cast("PathGuard", self)

    @property
    def reservation(self) -> PathReservation:
        """Itself, as a reservation."""
        return cast("PathReservation", self)

    @property
    def workspace(self) -> Workspace:
        """Itself, as a workspace."""
        return cast("Workspace", self)

    @property
    def watched(self) -> bool:
        """Whether somebody is notified of changes."""
        return bool(self._watchers)

    async def check(self, trajectory: JointTrajectory, rules: PathRules, *, from_s: float) -> PathCheck:
        """Return the answer, or raise it."""
        self.asked_s.append(from_s)
        self.rules.append(rules)
        self.paths.append(trajectory)
        answer = self.answer
        if self.takes_s:
            await asyncio.sleep(self.takes_s)
        if isinstance(answer, PathCheck):
            return answer
        raise answer

    def is_other_arm(self, pairs: tuple[NamePair, ...]) -> bool:
        """Return whether all contacts are with the other arm."""
        return bool(pairs) and all(pair == OTHER_ARM for pair in pairs)

    def change(self, *names: str, answer: PathCheck | FlexcellError | ValueError | None = None) -> None:
        """Notify of a change, after which the answer is another one."""
        if answer is not None:
            self.answer = answer
        for watcher in tuple(self._watchers):
            watcher(frozenset(names))

    def watch(self, watcher: Callable[[frozenset[str]], None]) -> Callable[[], None]:
        """Notify of changes, until the returned function is called."""
        self._watchers.append(watcher)
        return lambda: self._watchers.remove(watcher)

    def require(self) -> None:
        """Keep the cameras running."""
        self.required += 1

    def release(self) -> None:
        """Undo one `require`."""
        self.required -= 1

    def renew(self, trajectory: JointTrajectory) -> None:
        """Reserve another path from the next update on."""
        self.renewed.append(trajectory)

    def update(self, passed_s: float) -> None:
        """Reserve the remaining path."""
        self.reserved.append(passed_s)

    def withdraw(self) -> None:
        """Reserve nothing."""
        self.reserved.append(None)
