"""Looks ahead of a jog in the planning scene: lets it go as fast as it can still stop before what it would touch."""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from engine.errors import FlexcellError
from engine.skills.jogging import JogCollisionOptions
from robots.arm.motion_runner import MotionRunner
from robots.arm.path_planner import describe_contacts
from robots.arm.scene_check import SceneCheck
from robots.port import Array, JointTrajectory
from robots.workspace.workspace import Workspace

Row = tuple[float, ...]
ToJoints = Callable[[Array, Array], Array]
"""Gives the joints' velocities, (n,), for what is told, when the joints are at (n,)."""

# How often is looked, how old an answer may be when the arm heeds it, and when nobody looks any more.
_LOOK_S, _REACTION_S, _SILENT_S = 0.03, 0.12, 0.3
_STEP_S, _LONGEST_S = 0.01, 3.0
# The share of the accelerations with which a jog slows down (0.5, and its jerk), and of the free way that is used.
_BRAKING_SHARE, _USED_SHARE = 0.4, 0.9
# Below this share of what is told it stands.
_CREEP = 0.02
# A velocity that points within 11 degrees of the one that was looked at is taken to be that one.
_SAME_WAY = 0.98
_log = logging.getLogger("flexcell.arm")


@dataclass(frozen=True, kw_only=True)
class _SpeedLimit:
    """How fast a jog may go in a direction, of length 1, by what was looked at last."""

    direction: Array
    fastest: float


class JogGuard:
    """Watches the way ahead of one jog.

    Args:
        runner: Of the arm.
        workspace: Whose scene.
        rule: How far from what.
        to_joints: What the told velocities mean for the joints.
    """

    def __init__(
        self, runner: MotionRunner, workspace: Workspace, *, rule: JogCollisionOptions, to_joints: ToJoints
    ) -> None:
        self._runner = runner
        self._workspace = workspace
        self._scene = SceneCheck(runner.name, workspace, rule=rule)
        self._to_joints = to_joints
        self._braking_rad_s2 = np.array(runner.model.limits.acceleration_rad_s2) * _BRAKING_SHARE
        self._told = np.zeros(0)
        self._leave: _SpeedLimit | None = None
        self._news = asyncio.Event()
        self._looking: asyncio.Task[None] | None = None
        self.held_by = ""

    async def open(self) -> None:
        """Return when the scene is known and somebody looks at ways in it; `close` when the jog has ended.

        Raises:
            RobotError: nobody does.
            CellError: the scene is wrong.
        """
        self._workspace.require()
        try:
            standing = self._runner.port.sample().desired_rad[None]
            await self._scene.check(JointTrajectory(dt_s=_STEP_S, position_rad=standing, velocity_rad_s=standing * 0.0))
        except BaseException:
            self._workspace.release()
            raise

    def watch_ahead(self, again: Callable[[], None]) -> None:
        """Look ahead from now on; `again` tells the arm anew what it is told."""
        self._looking = asyncio.create_task(self._look_on(again), name=f"looking ahead of {self._runner.name}")

    async def close(self) -> None:
        """End what `open` began."""
        self._workspace.release()
        if self._looking is not None:
            self._looking.cancel()
            await asyncio.wait((self._looking,))

    def bounded(self, told: Row) -> Row:
        """Return what the arm may be told now in place of `told`."""
        self._told = np.array(told)
        fast, leave = float(np.linalg.norm(self._told)), self._leave
        if fast == 0.0:
            self.held_by, self._leave = "", None
            return told
        if leave is None or float(self._told @ leave.direction) < _SAME_WAY * fast:
            # It was not looked at yet; a moment later it is.
            self._leave = None
            self._news.set()
            return (0.0,) * len(told)
        return tuple((self._told * min(1.0, leave.fastest / fast)).tolist())

    async def _look_on(self, again: Callable[[], None]) -> None:
        while True:
            if not self._told.any():
                await self._news.wait()
            self._news.clear()
            told = self._told
            fastest, reason = await self._look(told)
            if reason and not self.held_by:
                _log.info("%s: the jog is held back: %s", self._runner.name, reason)
            self.held_by = reason
            self._leave = _SpeedLimit(direction=told / np.linalg.norm(told), fastest=fastest)
            again()
            with suppress(TimeoutError):
                async with asyncio.timeout(_LOOK_S):
                    await self._news.wait()

    async def _look(self, told: Array) -> tuple[float, str]:
        """Return how fast the arm may go where `told` points, and why no faster."""
        if self._scene.unobserved_reason:
            return 0.0, self._scene.unobserved_reason
        way, gone_s, slowing_s = self._ahead(told)
        try:
            async with asyncio.timeout(_SILENT_S):
                check = await self._scene.check(way)
        except TimeoutError:
            return 0.0, f"its path was not checked within {_SILENT_S:g} s"
        except FlexcellError as error:
            return 0.0, f"path monitoring is not available: {error.message}"
        if check.blocked_at_s is None:
            return float(np.linalg.norm(told)), ""
        # What is free ends with the sample before the one that touches.
        free_s = float(gone_s[max(0, round(check.blocked_at_s / _STEP_S) - 1)])
        return float(np.linalg.norm(told)) * _stoppable(free_s * _USED_SHARE, slowing_s), describe_contacts(check.pairs)

    def _ahead(self, told: Array) -> tuple[JointTrajectory, Array, float]:
        """Return where the arm goes that is told this until it heeds the next look, and then stops.

        With how far it has gone of what is told at each sample, in seconds of it, and how far it goes on while
        it slows down from all of it, in the same measure.
        """
        sample = self._runner.port.sample()
        joints, velocity = sample.desired_rad.copy(), sample.velocity_rad_s.copy()
        rows, gone = [joints], [0.0]
        heeded, longest = round(_REACTION_S / _STEP_S), round(_LONGEST_S / _STEP_S)
        wanted = self._to_joints(told, joints)
        for k in range(longest):
            if k < heeded:
                wanted = self._to_joints(told, joints)
            change = (wanted if k < heeded else 0.0) - velocity
            most = float((self._braking_rad_s2 * _STEP_S / np.maximum(np.abs(change), 1e-12)).min())
            velocity = velocity + change * min(1.0, most)
            joints = joints + velocity * _STEP_S
            share = float(velocity @ wanted) / max(1e-12, float(wanted @ wanted))
            rows.append(joints)
            gone.append(gone[-1] + max(0.0, share) * _STEP_S)
            if k >= heeded and not velocity.any():
                break
        way = np.array(rows)
        slowing_s = 0.5 * float((np.abs(wanted) / self._braking_rad_s2).max())
        return JointTrajectory(dt_s=_STEP_S, position_rad=way, velocity_rad_s=way * 0.0), np.array(gone), slowing_s


def _stoppable(free_s: float, slowing_s: float) -> float:
    """Return the share of a velocity from which an arm comes to rest within its free way, all in seconds of it.

    At a share k it goes on for k times the reaction, and for k² times `slowing_s` while it slows down.
    """
    share = (math.sqrt(_REACTION_S**2 + 4.0 * slowing_s * free_s) - _REACTION_S) / max(1e-9, 2.0 * slowing_s)
    return 0.0 if share < _CREEP else min(1.0, share)
