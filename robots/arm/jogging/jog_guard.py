"""Limits the speed of a jog in the planning scene, so that the arm can always stop before a collision."""

from __future__ import annotations

import asyncio
import logging
import math
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from engine.errors import FlexcellError
from engine.skills.jogging import JogBlock, JogCollisionOptions
from robots.arm.execution.collision_prediction import predict_collision
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.stopping_path import BRAKING_SHARE, REACTION_S
from robots.arm.jogging.directions_out import APART_M, DirectionsOut
from robots.arm.jogging.press_queue import Row
from robots.arm.scene_queries.attached_part_guard import AttachedPartGuard
from robots.arm.scene_queries.scene_check import SceneCheck
from robots.planning.request import PathCheck
from robots.planning.scene.planning_scene import NamePair
from robots.port import Array, JointTrajectory
from robots.workspace.workspace import Workspace

ToJoints = Callable[[Array, Array], Array]
"""Maps a commanded velocity and joint positions (n,) to joint velocities (n,)."""

_CHECK_PERIOD_S = 0.03
# The reaction time is the longest time in which one of so many checks took effect after the one before, and some more.
_CHECKS_REMEMBERED, _SLACK = 10, 1.25
# Timeout of a search for the directions out, which ends for another direction of the jog.
_SEARCH_TIMEOUT_S = 1.0
_STEP_S, _LONGEST_S = 0.01, 3.0
# Share of the free path that is used.
_USED_SHARE = 0.9
# Of a path that begins in contact so many samples apart are looked at.
_EVERY = 5
_ROUNDING_M = 1e-4
# Below this share of the commanded velocity the arm stands still.
_CREEP = 0.02
_REST_RAD_S = 0.005
# A velocity within 11 degrees of the checked direction counts as checked.
_SAME_DIRECTION = 0.98
# Within this the ways out are the same.
_SAME_PLACE_RAD = 0.01
_log = logging.getLogger("flexcell.arm")


@dataclass(frozen=True, kw_only=True)
class _SpeedLimit:
    """Speed limit of a jog along a unit direction, from the last check, and what it would touch there first.

    The check assumes that another one takes effect until `valid_until_s`; without one the arm must brake then.
    """

    direction: Array
    fastest: float
    pair: NamePair | None
    valid_until_s: float


@dataclass(frozen=True, kw_only=True)
class _PathAhead:
    """Where the arm goes if it follows what is commanded for the reaction time, and then stops.

    Distances are in seconds at the commanded velocity: `travelled_s` at each sample (n,), `slowing_s` while the arm
    decelerates from it. `moving` is the share of that velocity with which the arm moves now.
    """

    trajectory: JointTrajectory
    travelled_s: Array
    slowing_s: float
    moving: float


class JogGuard:
    """Monitors the path ahead of one jog.

    Args:
        runner: The arm's motion runner.
        workspace: Provides the scene.
        rule: Margin, and the objects that may be touched.
        to_joints: Maps commanded velocities to joint velocities.
        directions_out: Finds the directions that lead away from what the arm stands before.
        publish: Receives what the arm stands before, and after every check that finds nothing that it goes free.
    """

    def __init__(
        self,
        runner: MotionRunner,
        workspace: Workspace,
        *,
        rule: JogCollisionOptions,
        to_joints: ToJoints,
        directions_out: DirectionsOut,
        publish: Callable[[JogBlock], None],
    ) -> None:
        self._runner = runner
        self._workspace = workspace
        self._scene = SceneCheck(runner.name, workspace, rule=rule)
        self._attached = AttachedPartGuard(runner.name, workspace)
        self._to_joints = to_joints
        self._directions_out = directions_out
        self._publish = publish
        self._published: tuple[NamePair, Array] | None = None
        self._braking_rad_s2 = np.array(runner.model.limits.acceleration_rad_s2) * BRAKING_SHARE
        self._commanded = np.zeros(0)
        self._limit: _SpeedLimit | None = None
        self._cycles_s: deque[float] = deque(maxlen=_CHECKS_REMEMBERED)
        self._recheck = asyncio.Event()
        self._monitoring: asyncio.Task[None] | None = None
        self._failure = ""
        self.held_by = ""

    @property
    def is_blocked(self) -> bool:
        """Whether the commanded direction is checked, and the arm stands there before an obstacle."""
        limit = self._limit
        return limit is not None and limit.fastest == 0.0 and limit.pair is not None

    @property
    def valid_s(self) -> float:
        """For how long the arm may follow what `bounded` returned; infinite where that does not move it."""
        return math.inf if self._limit is None else self._limit.valid_until_s - self._runner.clock.now_s()

    @property
    def _is_at_rest(self) -> bool:
        """Whether the arm stands and is not let move before the next check takes effect."""
        is_held = self._limit is None or self._limit.fastest == 0.0
        return is_held and float(np.abs(self._runner.port.sample().velocity_rad_s).max()) < _REST_RAD_S

    @property
    def _reaction_s(self) -> float:
        """Greatest age of the result of a check when the next one takes effect, on a machine as busy as lately."""
        return max(REACTION_S, _SLACK * max(self._cycles_s, default=0.0))

    async def open(self) -> None:
        """Return when the scene and the path checks are ready; call `close` when the jog has ended.

        Raises:
            RobotError: path checks are not available.
            CellError: the scene is invalid.
        """
        self._workspace.require()
        try:
            at_rest = self._runner.port.sample().desired_rad[None]
            await self._scene.check(JointTrajectory(dt_s=_STEP_S, position_rad=at_rest, velocity_rad_s=at_rest * 0.0))
        except BaseException:
            self._workspace.release()
            raise

    def watch_ahead(self, again: Callable[[], None]) -> None:
        """Start to monitor the path ahead; `again` resends the current command to the arm."""
        self._monitoring = asyncio.create_task(self._monitor(again), name=f"jog monitoring of {self._runner.name}")

    async def close(self) -> None:
        """Stop monitoring and release the scene."""
        self._workspace.release()
        if self._monitoring is not None:
            self._monitoring.cancel()
            await asyncio.wait((self._monitoring,))

    def bounded(self, commanded: Row) -> Row:
        """Return the velocity that the arm may be commanded now in place of `commanded`."""
        if self._failure:
            self.held_by = self._failure
            return (0.0,) * len(commanded)
        self._commanded = np.array(commanded)
        fast, limit = float(np.linalg.norm(self._commanded)), self._limit
        if fast == 0.0:
            self.held_by, self._limit = "", None
            return commanded
        if limit is None or float(self._commanded @ limit.direction) < _SAME_DIRECTION * fast:
            # This direction is not checked yet; request a check and stand still until then.
            self._limit = None
            self._recheck.set()
            return (0.0,) * len(commanded)
        return tuple((self._commanded * min(1.0, limit.fastest / fast)).tolist())

    async def _monitor(self, again: Callable[[], None]) -> None:
        try:
            await self._look_ahead(again)
        except Exception as error:
            # Whatever fails here, the arm must not continue unmonitored.
            _log.exception("%s: jog monitoring failed", self._runner.name)
            self._failure = f"jog monitoring failed: {type(error).__name__}: {error}"
            again()

    async def _look_ahead(self, again: Callable[[], None]) -> None:
        clock = self._runner.clock
        before_s = math.inf
        while True:
            while not self._commanded.any():
                # A key that was released at once leaves a request without a direction.
                self._recheck.clear()
                before_s = math.inf
                await self._recheck.wait()
            self._recheck.clear()
            commanded, begun_s, reaction_s = self._commanded, clock.now_s(), self._reaction_s
            is_waiting = self._is_at_rest
            fastest, reason, pair = await self._check(commanded, begun_s=begun_s, reaction_s=reaction_s)
            self._cycles_s.append(clock.now_s() - min(before_s, begun_s))
            before_s = begun_s
            if reason and not self.held_by:
                _log.info("%s: jog speed limited: %s", self._runner.name, reason)
            self.held_by = reason
            self._limit = _SpeedLimit(
                direction=commanded / np.linalg.norm(commanded),
                fastest=fastest,
                pair=pair,
                # An arm that waited for the check sets out from where the check began.
                valid_until_s=(clock.now_s() if is_waiting else begun_s) + reaction_s,
            )
            again()
            await self._publish_block(pair if fastest == 0.0 else None, is_free=not reason)
            with suppress(TimeoutError):
                async with asyncio.timeout(_CHECK_PERIOD_S):
                    await self._recheck.wait()

    async def _publish_block(self, pair: NamePair | None, *, is_free: bool) -> None:
        """Tell what the arm stands before, once at a place, or that it goes free."""
        name = self._runner.name
        if pair is None:
            if is_free:
                self._published = None
                self._publish(JogBlock(robot=name))
            return
        joints = self._runner.port.sample().desired_rad.copy()
        if (
            self._published is not None
            and self._published[0] == pair
            and np.abs(joints - self._published[1]).max() < _SAME_PLACE_RAD
        ):
            return
        self._publish(JogBlock(robot=name, first=pair[0], second=pair[1]))
        block = await self._search(pair)
        if block is None:
            # The next check tries again.
            self._published = None
            return
        self._published = pair, joints
        self._publish(block)

    async def _search(self, pair: NamePair) -> JogBlock | None:
        """Return a block with its directions out; None if they are not found in time, or another one is commanded."""
        search = asyncio.create_task(self._directions_out.find(self._scene, pair))
        recheck = asyncio.create_task(self._recheck.wait())
        try:
            await asyncio.wait((search, recheck), timeout=_SEARCH_TIMEOUT_S, return_when=asyncio.FIRST_COMPLETED)
            return search.result() if search.done() else None
        except FlexcellError as error:
            _log.warning("%s: the directions out are not known: %s", self._runner.name, error)
            return None
        finally:
            search.cancel()
            recheck.cancel()
            await asyncio.wait((search, recheck))

    async def _check(
        self, commanded: Array, *, begun_s: float, reaction_s: float
    ) -> tuple[float, str, NamePair | None]:
        """Return the speed limit in the direction of `commanded`, the reason for it, and the pair that would touch."""
        ahead = self._ahead(commanded, reaction_s)
        path = ahead.trajectory
        found = await predict_collision(self._workspace, self._first_contact(path))
        if found is None:
            return float(np.linalg.norm(commanded)), "", None
        if found.at_s == 0.0 and await self._takes_apart(path, found.pairs):
            found = await predict_collision(self._workspace, self._first_contact(path, parting=found.pairs))
            if found is None:
                return float(np.linalg.norm(commanded)), "", None
        if found.is_unmonitored:
            return 0.0, found.reason, None
        # The free path ends at the sample before the first contact.
        free_s = float(ahead.travelled_s[max(0, round(found.at_s / _STEP_S) - 1)])
        passed_s = self._runner.clock.now_s() - begun_s
        share = _stoppable_share(
            free_s * _USED_SHARE - ahead.moving * passed_s, ahead, reaction_s=reaction_s - passed_s
        )
        return (
            float(np.linalg.norm(commanded)) * share,
            found.reason,
            self._pair_of(found.pairs),
        )

    async def _first_contact(self, path: JointTrajectory, *, parting: tuple[NamePair, ...] = ()) -> PathCheck:
        """Return where the path is blocked first: in the scene, or by what an attached part would be pressed into.

        The scene allows contact of a part with what it was picked from, at any depth.
        """
        check = await self._scene.check(path, parting=parting)
        attached = await self._attached.check(path)
        if attached.blocked_at_s is None or not set(attached.pairs).difference(parting):
            return check
        return check if check.blocked_at_s is not None and check.blocked_at_s <= attached.blocked_at_s else attached

    async def _takes_apart(self, path: JointTrajectory, touching: Sequence[NamePair]) -> bool:
        """Return whether a path that begins in contact takes all that touch apart, all the way.

        Checks of paths let an arm leave a margin, but no contact: it may have been pressed, or have slipped, into one.
        """
        if not touching:
            return False
        rows = np.concatenate((path.position_rad[:-1:_EVERY], path.position_rad[-1:]))
        try:
            async with asyncio.timeout(_SEARCH_TIMEOUT_S):
                gaps_m = [np.array((await self._scene.distances(rows, pair)).distance_m) for pair in touching]
        except (TimeoutError, FlexcellError) as error:
            _log.warning("%s: whether it goes out of a contact is not known: %s", self._runner.name, error)
            return False
        return all(bool((np.diff(gap_m) > -_ROUNDING_M).all()) and gap_m[-1] > gap_m[0] + APART_M for gap_m in gaps_m)

    def _pair_of(self, pairs: Sequence[NamePair]) -> NamePair | None:
        """Return the pair to tell: that of before while it is among them, as both fingers of a hand are in turn."""
        if self._published is not None and self._published[0] in pairs:
            return self._published[0]
        return pairs[0] if pairs else None

    def _ahead(self, commanded: Array, reaction_s: float) -> _PathAhead:
        sample = self._runner.port.sample()
        joints, velocity = sample.desired_rad.copy(), sample.velocity_rad_s.copy()
        rows, travelled = [joints], [0.0]
        reaction, longest = math.ceil(reaction_s / _STEP_S), round(_LONGEST_S / _STEP_S)
        requested = self._to_joints(commanded, joints)
        moving = max(0.0, _share(velocity, requested))
        for k in range(longest):
            if k < reaction:
                requested = self._to_joints(commanded, joints)
            change = (requested if k < reaction else 0.0) - velocity
            most = float((self._braking_rad_s2 * _STEP_S / np.maximum(np.abs(change), 1e-12)).min())
            velocity = velocity + change * min(1.0, most)
            joints = joints + velocity * _STEP_S
            rows.append(joints)
            travelled.append(travelled[-1] + max(0.0, _share(velocity, requested)) * _STEP_S)
            if k >= reaction and not velocity.any():
                break
        path = np.array(rows)
        return _PathAhead(
            trajectory=JointTrajectory(dt_s=_STEP_S, position_rad=path, velocity_rad_s=path * 0.0),
            travelled_s=np.array(travelled),
            slowing_s=0.5 * float((np.abs(requested) / self._braking_rad_s2).max()),
            moving=moving,
        )


def _share(velocity: Array, requested: Array) -> float:
    """Return the component of a velocity along another one, as a share of that one."""
    return float(velocity @ requested) / max(1e-12, float(requested @ requested))


def _stoppable_share(free_s: float, ahead: _PathAhead, *, reaction_s: float) -> float:
    """Return the share of a velocity from which an arm stops within its free path, all in seconds at that velocity.

    At a share k it travels k times the reaction time, plus k² times `slowing_s` while it decelerates; an arm that
    moves at a greater share now decelerates from that one.
    """
    reaction_s, free_s, slowing_s = max(1e-9, reaction_s), max(0.0, free_s), ahead.slowing_s
    share = (math.sqrt(reaction_s**2 + 4.0 * slowing_s * free_s) - reaction_s) / max(1e-9, 2.0 * slowing_s)
    if share < ahead.moving:
        share = (free_s - ahead.moving**2 * slowing_s) / reaction_s
    return 0.0 if share < _CREEP else min(1.0, share)
