"""Guards one motion along a given path: it is admitted only on a free path, and monitored while it moves."""

from __future__ import annotations

import logging
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Literal

import msgspec
import numpy as np

from engine.errors import PathBlocked
from engine.skills.collision_options import CollisionOptions
from robots.arm.scene_queries.attached_part_guard import AttachedPartGuard
from robots.arm.scene_queries.path_planner import describe_contacts, with_fixed_base
from robots.arm.scene_queries.unknown_space_check import UNKNOWN_SPACE_HINT, UnknownSpaceCheck
from robots.model.mechanics.kinematics import ArmKinematics
from robots.motion.slow_section import slow_section
from robots.planning.request import CollisionRequest, PathCheck, PathCheckRequest, ToolContact
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.port import Array, JointTrajectory
from robots.workspace.path_reservations import is_reserved
from robots.workspace.unknown_space import SLOW_SPEED
from robots.workspace.workspace import Workspace

# Parts this near to the tool at the start of a motion count as carried: fingers hold a part by its measured pose.
_CARRIED_M = 0.002
_MOVED_RAD = 1e-3
# Unknown space is reached up to this earlier than the swept space says: it is looked at in steps.
_EARLY_S = 0.2
_HINT = (
    "choose another path or goal, plan one with `MoveFree`, or name what may be touched: "
    "`collisions: {may_touch: [name]}`; `collisions: {avoid: false}` switches the check off"
)
_log = logging.getLogger("flexcell.arm")

Timing = Literal["free", "fixed"]
"""Whether a motion may be slowed: `fixed` where its task depends on the time."""


@dataclass(frozen=True, kw_only=True)
class PathRules:
    """The contacts that one motion may make: those of its kind, and those with the names in `may_touch`.

    With a `person_at_arm`, who leads it, what the cameras see is no obstacle.
    """

    tool_contact: ToolContact = "at_end"
    may_touch: tuple[str, ...] = ()
    person_at_arm: bool = False


@dataclass(frozen=True, kw_only=True)
class AdmittedPath:
    """A path that is free by its rules; `trajectory` is the given one, or slowed where it passes unknown space."""

    trajectory: JointTrajectory
    rules: PathRules


class PathGuard:
    """Checks the given paths of one arm.

    Args:
        arm: Name of the arm.
        workspace: Provides the scene, the occupancy and the planners.
    """

    def __init__(self, arm: str, workspace: Workspace) -> None:
        self.arm = arm
        self.workspace = workspace
        self._attached = AttachedPartGuard(arm, workspace)
        self._unknown_space = UnknownSpaceCheck(arm, workspace)

    @asynccontextmanager
    async def observed(self) -> AsyncGenerator[None]:
        """Keep the cameras running meanwhile."""
        self.workspace.require()
        try:
            yield
        finally:
            self.workspace.release()

    async def admit(
        self,
        trajectory: JointTrajectory,
        *,
        options: CollisionOptions,
        tool_contact: ToolContact,
        kinematics: ArmKinematics,
        timing: Timing = "free",
    ) -> AdmittedPath:
        """Return the path with the rules by which it is free now, and is to be checked during the motion.

        Raises:
            PathBlocked: a contact, or unknown space where the cell does not accept it; the message names both bodies
                and the place.
            RobotError: the planning process has ended, or the cameras do not work.
            CellError: the scene is invalid.
        """
        workspace = self.workspace
        await workspace.ready()
        await workspace.fresh()
        if tool_contact == "at_end":
            # The scene allows contact of a part with what it was picked from, at any depth.
            await self._attached.require_free(trajectory)
        rules = await self.rules_at(trajectory.position_rad[0], options=options, tool_contact=tool_contact)
        check = await self.check(trajectory, rules, from_s=0.0)
        if check.blocked_at_s is not None and not await self._moves_away(check.pairs):
            raise PathBlocked(
                f"{describe_contacts(check.pairs)} {_place(trajectory, check.blocked_at_s, kinematics)}",
                where=self.arm,
                hint=_HINT,
            )
        known = await self._through_known_space(trajectory, kinematics, timing)
        return AdmittedPath(trajectory=known, rules=rules)

    async def rules_at(
        self, joints: Array, *, options: CollisionOptions, tool_contact: ToolContact, person_at_arm: bool = False
    ) -> PathRules:
        """Return the rules of a motion that starts at `joints` (n,); raises as `admit` does."""
        carried = await self._carried(joints)
        return PathRules(
            tool_contact=tool_contact, may_touch=(*options.may_touch, *carried), person_at_arm=person_at_arm
        )

    async def check(self, trajectory: JointTrajectory, rules: PathRules, *, from_s: float) -> PathCheck:
        """Return where the remaining path is blocked in the current scene; raises as `admit` does."""
        workspace = self.workspace
        scene = with_fixed_base(workspace.scene_for(self.arm), self.arm)
        return await workspace.planners.check_path(
            PathCheckRequest(
                scene=self._allowing(scene, rules.may_touch),
                arm=self.arm,
                trajectory=trajectory,
                from_s=from_s,
                occupancy=None if rules.person_at_arm else workspace.occupancy,
                tool_contact=rules.tool_contact,
            )
        )

    def is_other_arm(self, pairs: tuple[NamePair, ...]) -> bool:
        """Return whether all contacts are with other arms, or what they hold, which may be gone by then."""
        scene = self.workspace.scene_for(self.arm)
        others = {arm.name for arm in scene.arms} | {part.name for part in scene.attached if part.arm != self.arm}
        others.discard(self.arm)
        return bool(pairs) and all(any(name.partition("/")[0] in others for name in pair) for pair in pairs)

    def _allowing(self, scene: PlanningScene, names: tuple[str, ...]) -> PlanningScene:
        if not names:
            return scene
        own = (self.arm, *(part.name for part in scene.attached if part.arm == self.arm))
        pairs = tuple((body, name) for body in own for name in names if name != body)
        return msgspec.structs.replace(scene, allowed=scene.allowed + pairs)

    async def _carried(self, joints: Array) -> tuple[str, ...]:
        """Return the parts that nobody has attached and that the arm touches at the start: they go with its tool."""
        workspace = self.workspace
        parts = workspace.part_names
        scene = workspace.scene_for(self.arm)
        if parts.isdisjoint(one.name for one in scene.obstacles):
            return ()
        report = await workspace.planners.look(
            CollisionRequest(scene=scene, arm=self.arm, joints_rad=tuple(float(q) for q in joints), margin_m=_CARRIED_M)
        )
        touched = {name for pair in report.touching for name in (pair.first, pair.second)}
        # A part that was detached may touch the links that still hold it.
        own = f"{self.arm}/"
        touched |= {name for pair in scene.allowed for name in pair if any(one.startswith(own) for one in pair)}
        return tuple(sorted(touched & parts))

    async def _moves_away(self, pairs: tuple[NamePair, ...]) -> bool:
        """Return whether the path is blocked only by an arm that moves: monitoring then stops this one in time."""
        if not self.is_other_arm(pairs):
            return False
        workspace = self.workspace
        before = workspace.scene_for(self.arm)
        await workspace.pause()
        after = workspace.scene_for(self.arm)
        holder = {part.name: part.arm for part in before.attached}
        names = {name.partition("/")[0] for pair in pairs for name in pair}
        # Only an arm that moves reserves its path.
        arms = {holder.get(name, name) for name in names if not is_reserved(name)} - {self.arm}
        known = {arm.name for arm in before.arms} & {arm.name for arm in after.arms}
        return all(
            name not in known
            or np.abs(np.array(before.arm(name).joints_rad) - np.array(after.arm(name).joints_rad)).max(initial=0.0)
            > _MOVED_RAD
            for name in arms
        )

    async def _through_known_space(
        self, trajectory: JointTrajectory, kinematics: ArmKinematics, timing: Timing
    ) -> JointTrajectory:
        """Return the trajectory if the cell accepts the unknown space on it, slowed there by the policy `slow`."""
        policy, unknown = self.workspace.unknown_space.policy, self._unknown_space
        swept = await (unknown.once_observed if policy == "look_first" else unknown.on)(trajectory)
        if swept is None:
            return trajectory
        message = unknown.refusal(swept, trajectory).message
        if policy == "slow":
            limits = kinematics.model.limits
            from_s = max(0.0, swept.at_s - _EARLY_S)
            slowed = slow_section(trajectory, from_s=from_s, to_s=swept.last_s, speed=SLOW_SPEED, limits=limits)
            if slowed is trajectory or timing == "free":
                _log.info("%s moves at most at %.0f %% of its speed there: %s", self.arm, 100.0 * SLOW_SPEED, message)
                return slowed
            message += (
                f"; at most {SLOW_SPEED:.0%} of the joint speed limits are accepted there, "
                "and this motion cannot be slowed"
            )
        raise PathBlocked(message, where=self.arm, hint=UNKNOWN_SPACE_HINT)


def _place(trajectory: JointTrajectory, at_s: float, kinematics: ArmKinematics) -> str:
    """Return where on a path the tool is at an instant: how far along it, and in the world."""
    rows = trajectory.position_rad
    row = min(round(at_s / trajectory.dt_s), len(rows) - 1)
    share = at_s / trajectory.duration_s if trajectory.duration_s else 0.0
    start, tool = kinematics.tool_pose(rows[0]).xyz, kinematics.tool_pose(rows[row]).xyz
    at = ", ".join(f"{value:.2f}" for value in tool.tolist())
    return f"after {share:.0%} of the path, {np.linalg.norm(tool - start):.2f} m from here, with the tool at ({at}) m"
