"""The current planning scene of a cell: from its document, from added obstacles and from measurements."""

from __future__ import annotations

import logging
from collections.abc import Collection

import msgspec

from engine.errors import SkillFailed
from engine.messages.shapes import Obstacle, Solid
from engine.skills.planning_scene import HeldPart, PlanningSceneState
from engine.wording import did_you_mean
from robots.model.mechanics.link_names import link_names
from robots.model.transform import RigidTransform
from robots.planning.scene.planning_scene import AttachedPart, NamePair, PlanningScene, SceneArm
from robots.scene.sim_scene import ArmPlacement
from robots.workspace.grasped_parts import GraspedPart, ReleasedPart
from robots.workspace.measured_poses import MeasuredPoses, PoseSource
from robots.workspace.obstacle_validation import find_obstacle_fault
from robots.workspace.path_reservations import Row, with_reservations
from robots.workspace.proximity import SEPARATED_M, TOUCHING_M, links_near_part, names_near_held_part
from robots.workspace.tracked_objects import TrackedObjects

OCCUPANCY = "occupancy"
"""Name of the obstacle that stands for the occupancy map: unknown objects seen by cameras."""

_log = logging.getLogger("flexcell.workspace")


class SceneMemo(msgspec.Struct, frozen=True, kw_only=True):
    """The state of a scene that is neither in the cell document nor measured."""

    put: tuple[Obstacle, ...] = ()
    removed: tuple[str, ...] = ()
    rules: tuple[tuple[str, str, bool], ...] = ()
    held: tuple[GraspedPart, ...] = ()
    let_go: tuple[ReleasedPart, ...] = ()


class LiveScene:
    """The live planning scene; changes only by its methods, and `refresh` applies measurements.

    Args:
        base: The scene of the cell document.
        parts: Names of its parts, whose poses are measured.
        look: Measures the cell.

    Methods that take a name raise SkillFailed if it is unknown, or if the change is not allowed.
    """

    def __init__(self, base: PlanningScene, *, parts: Collection[str], look: PoseSource) -> None:
        self._base = base
        self._parts = frozenset(parts)
        self._look = look
        self._tracked = TrackedObjects()
        self._put: dict[str, Obstacle] = {}
        self._removed: set[str] = set()
        self._rules: dict[frozenset[str], tuple[str, str, bool]] = {}
        self._held: dict[str, GraspedPart] = {}
        self._let_go: dict[str, ReleasedPart] = {}
        self._detached_in_grip: set[tuple[str, str]] = set()
        self._reservations: dict[str, tuple[Row, ...]] = {}
        self.revision = 0

    def take_base(
        self, obstacles: tuple[Obstacle, ...], *, parts: Collection[str], arms: Collection[ArmPlacement] = ()
    ) -> frozenset[str]:
        """Replace the fixtures and parts of the cell, and where `arms` stand; return the names of all that changed.

        What is known of those that went is forgotten: they come back as new.
        """
        before = {one.name: one for one in self._base.obstacles}
        now = {one.name: one for one in obstacles}
        gone = before.keys() - now.keys()
        changed = gone | {name for name, one in now.items() if before.get(name) != one}
        placed = {one.name: one for one in arms}
        moved = {one.name for one in self._base.arms if placed.get(one.name, one.placement) != one.placement}
        placed_arms = tuple(
            msgspec.structs.replace(one, placement=placed[one.name]) if one.name in moved else one
            for one in self._base.arms
        )
        self._base = msgspec.structs.replace(self._base, obstacles=obstacles, arms=placed_arms)
        self._parts = frozenset(parts)
        self._tracked.forget(gone)
        self._removed -= changed
        for name in changed:
            self._put.pop(name, None)
        for name in gone:
            self._held.pop(name, None)
            self._let_go.pop(name, None)
        self.revision += 1
        return frozenset(changed | moved)

    @property
    def arms(self) -> int:
        """Number of arms."""
        return len(self._base.arms)

    @property
    def part_names(self) -> frozenset[str]:
        """Names of the parts, whose poses are measured."""
        return self._parts

    def refresh(self) -> frozenset[str]:
        """Apply new measurements; return the names of parts, held parts and arms that have changed."""
        measured = self._look()
        parts, arms = self._tracked.take(measured)
        changed = {name for name in parts if name not in self._held}
        for name, held in tuple(self._held.items()):
            if self._update_held(name, held, measured):
                changed.add(name)
        changed |= self._follow_grips(measured)
        if changed:
            self.revision += 1
        if parts or arms:
            self._revoke_contacts()
        return frozenset(changed | arms)

    def scene_for(self, arm: str) -> PlanningScene:
        """Return the scene for `arm`: other arms at their tracked joints and along the paths they have reserved.

        Contains nothing that changes as the arm itself moves, so that it stays equal meanwhile.
        """
        scene = self.whole()
        own = msgspec.structs.replace(scene.arm(arm), joints_rad=())
        scene = msgspec.structs.replace(scene, arms=tuple(own if a.name == arm else a for a in scene.arms))
        return with_reservations(scene, self._reservations_before(arm))

    def holds(self, arm: str) -> bool:
        """Return whether an arm held a part at the last measurement, attached or by contact."""
        return bool(self.attached_to(arm))

    def attached_to(self, arm: str) -> tuple[AttachedPart, ...]:
        """Return the parts that an arm held at the last measurement."""
        return tuple(one.part for one in self._held.values() if one.part.arm == arm)

    def lies(self, arm: str) -> bool:
        """Return whether a part held by an arm still touches the object that it was picked from."""
        return any(one.part.arm == arm and one.touches for one in self._held.values())

    def attached_check_scene_for(self, arm: str) -> PlanningScene | None:
        """Return the scene to check the attached parts of `arm`, None if it holds nothing.

        It does not allow contact with the objects that held parts lie on: the check itself decides that from
        the goal of the motion.
        """
        if not self.holds(arm):
            return None
        held = {name: one for name, one in self._held.items() if one.part.arm == arm}
        resting = {(name, other) for name, one in held.items() for other in one.touches}.difference(
            self._allowed_by_rules()
        )
        scene = self.scene_for(arm)
        return msgspec.structs.replace(scene, allowed=tuple(pair for pair in scene.allowed if pair not in resting))

    def whole(self) -> PlanningScene:
        """Return the scene with all arms at their tracked joints."""
        objects = self._tracked
        arms = tuple(
            SceneArm(placement=a.placement, joints_rad=now.joints_rad, tool_joints=now.tool_joints)
            if (now := objects.arms.get(a.name)) is not None
            else a
            for a in self._base.arms
        )
        return PlanningScene(arms=arms, obstacles=self._obstacles(), attached=self._attached(), allowed=self._allowed())

    def state(self) -> PlanningSceneState:
        """Return the scene as its bus message."""
        held = tuple(
            HeldPart(name=p.name, robot=p.arm, link=one.link, solids=p.solids, pose=p.pose)
            for one in self._held.values()
            for p in (one.part,)
        )
        return PlanningSceneState(
            revision=self.revision, obstacles=self._obstacles(), held=held, allowed=self._allowed()
        )

    def put(self, obstacle: Obstacle) -> None:
        """Add an obstacle, or replace the one with the same name."""
        name = obstacle.name
        if fault := find_obstacle_fault(obstacle):
            raise _refused(fault, "give shapes with sizes in meters, at a pose in the world")
        if name in self._parts or name in self._held:
            raise _refused(f"{name} is a part, whose pose is measured", "give the obstacle another name")
        if name == OCCUPANCY or name.partition("/")[0] in self._arm_names() or "~" in name:
            raise _refused(f"the obstacle name {name} is reserved", "give the obstacle another name")
        self._put[name] = obstacle
        self._removed.discard(name)
        self.revision += 1

    def remove(self, name: str) -> None:
        """Remove an obstacle; one that is already removed is not an error."""
        if name in self._removed:
            return
        if name in self._parts or name in self._held:
            raise _refused(f"{name} is a part, whose pose is measured", "allow its contacts, or attach it")
        if name not in {one.name for one in self._obstacles()}:
            raise _unknown("obstacle", name, [one.name for one in self._obstacles()])
        self._put.pop(name, None)
        self._removed.add(name)
        self.revision += 1

    def allow(self, first: str, second: str, *, allowed: bool) -> None:
        """Set whether two objects may touch."""
        for name in (first, second):
            self._require_known(name)
        self._rules[frozenset((first, second))] = (first, second, allowed)
        self.revision += 1

    def attach(self, part: str, arm: str, link: str) -> None:
        """Attach a part at its current pose to a link of an arm (the tool link if `link` is empty)."""
        if arm not in self._arm_names():
            raise _unknown("arm", arm, sorted(self._arm_names()))
        model = self._base.arm(arm).placement.robot()
        frame = link or model.tool_link
        if frame not in link_names(model):
            raise _unknown(f"link of {arm}", frame, sorted(link_names(model)))
        before = self._held.get(part)
        if before is not None and (before.part.arm, before.link) == (arm, frame):
            self._held[part] = msgspec.structs.replace(before, by_contact=False)
            return
        measured = self._look()
        self._tracked.take(measured)
        self._take(part, arm, link, measured, by_contact=False)
        self.revision += 1

    def detach(self, part: str) -> None:
        """Detach a part; one that is not attached is not an error."""
        if part not in self._held:
            self._require_known(part)
            return
        # It is still in the grip, but whoever detaches it means it as put down.
        self._detached_in_grip.add((part, self._held[part].part.arm))
        self._drop(part, self._look())
        self.revision += 1

    def claim(self, arm: str, rows: tuple[Row, ...]) -> None:
        """Reserve the configurations that a moving arm will pass; arms without an earlier reservation avoid them.

        Empty `rows` release the reservation.
        """
        if rows:
            self._reservations[arm] = rows
        else:
            self._reservations.pop(arm, None)

    def memo(self) -> SceneMemo:
        """Return the state that a restore needs."""
        return SceneMemo(
            put=tuple(self._put.values()),
            removed=tuple(sorted(self._removed)),
            rules=tuple(self._rules.values()),
            held=tuple(self._held.values()),
            let_go=tuple(self._let_go.values()),
        )

    def remember(self, memo: SceneMemo) -> None:
        """Restore the state of `memo`."""
        self._put = {one.name: one for one in memo.put}
        self._removed = set(memo.removed)
        self._rules = {frozenset(rule[:2]): rule for rule in memo.rules}
        self._held = {one.part.name: one for one in memo.held}
        self._let_go = {one.part: one for one in memo.let_go}
        self._reservations.clear()
        self.revision += 1

    def _take(self, part: str, arm: str, link: str, measured: MeasuredPoses, *, by_contact: bool) -> None:
        """Fix a part to a link of an arm, the tool link if `link` is empty; what it touches there stays allowed."""
        frame = link or self._base.arm(arm).placement.robot().tool_link
        solids = self._solids_of(part)
        at = measured.link(arm, frame).inverse().then(self._pose_of(part, measured))
        attached = AttachedPart(name=part, arm=arm, solids=solids, pose=at.to_pose(frame), link=link)
        self._put.pop(part, None)
        self._let_go.pop(part, None)
        taken = GraspedPart(
            part=attached, link=frame, taken=at.to_pose(frame), touches=frozenset(), by_contact=by_contact
        )
        self._held[part] = taken
        touches = names_near_held_part(self._measured(measured), part, within_m=TOUCHING_M)
        self._held[part] = msgspec.structs.replace(taken, touches=touches)
        how = ", by contact" if by_contact else ""
        _log.info("%s holds %s%s%s", arm, part, how, f"; it touches {', '.join(sorted(touches))}" if touches else "")

    def _follow_grips(self, measured: MeasuredPoses) -> set[str]:
        """Take the parts that tools are measured to hold, and drop those that they have let go; return their names."""
        grips = {(arm.holds, name) for name, arm in measured.arms.items() if arm.holds in self._parts}
        # What is held carries what is joined to it.
        carrying = (grips - self._detached_in_grip) | {
            (name, held.part.arm) for name, held in self._held.items() if not held.by_contact
        }
        grips |= {(other, arm) for name, arm in carrying for other in measured.joined_parts(name)}
        changed: set[str] = set()
        for name, held in tuple(self._held.items()):
            if held.by_contact and (name, held.part.arm) not in grips:
                _log.info("%s has let go of %s", held.part.arm, name)
                self._drop(name, measured)
                changed.add(name)
        self._detached_in_grip &= grips
        for name, arm in sorted(grips - self._detached_in_grip):
            if name not in self._held:
                self._take(name, arm, "", measured, by_contact=True)
                changed.add(name)
        return changed

    def _update_held(self, name: str, held: GraspedPart, measured: MeasuredPoses) -> bool:
        """Update the pose of a held part in the hand; return true if it has changed, or if the part is lost."""
        if name not in measured.parts:
            return False
        now = held.slipped_to(measured.link(held.part.arm, held.link).inverse().then(measured.parts[name]))
        if now is held:
            return False
        if now is None:
            _log.warning("%s has lost %s; the scene uses its measured pose", held.part.arm, name)
            self._drop(name, measured)
        else:
            self._held[name] = now
        return True

    def _drop(self, name: str, measured: MeasuredPoses) -> None:
        held = self._held.pop(name)
        if name not in self._parts:
            at = measured.link(held.part.arm, held.link).then(RigidTransform.from_pose(held.part.pose))
            self._put[name] = Obstacle(name=name, solids=held.part.solids, pose=at.to_pose("world"))
        self._tracked.take(measured)
        links = links_near_part(self._measured(measured), name, held.part.arm, within_m=SEPARATED_M)
        if links:
            self._let_go[name] = ReleasedPart(part=name, arm=held.part.arm, links=links)

    def _revoke_contacts(self) -> None:
        """Revoke the allowed contacts of objects that have separated."""
        scene = self.whole()
        for name, held in tuple(self._held.items()):
            if held.touches:
                close_names = names_near_held_part(scene, name, within_m=SEPARATED_M, among=held.touches)
                self._held[name] = msgspec.structs.replace(held, touches=held.touches & close_names)
        for name, released in tuple(self._let_go.items()):
            links = released.links & links_near_part(scene, name, released.arm, within_m=SEPARATED_M)
            if links:
                self._let_go[name] = msgspec.structs.replace(released, links=links)
            else:
                del self._let_go[name]

    def _measured(self, measured: MeasuredPoses) -> PlanningScene:
        """Return the scene with the arms at exactly their measured joints."""
        scene = self.whole()
        for name, arm in measured.arms.items():
            scene = scene.with_joints(name, arm.joints_rad, tool_joints=dict(arm.tool_joints))
        return scene

    def _obstacles(self) -> tuple[Obstacle, ...]:
        obstacles: list[Obstacle] = []
        for one in self._base.obstacles:
            if one.name in self._held or one.name in self._put or one.name in self._removed:
                continue
            resting = self._tracked.parts.get(one.name) if one.name in self._parts else None
            obstacles.append(one if resting is None else msgspec.structs.replace(one, pose=resting))
        return (*obstacles, *self._put.values())

    def _attached(self) -> tuple[AttachedPart, ...]:
        return tuple(one.part for one in self._held.values())

    def _allowed_by_rules(self) -> list[NamePair]:
        pairs = [pair for pair in self._base.allowed if frozenset(pair) not in self._rules]
        return pairs + [(first, second) for first, second, allowed in self._rules.values() if allowed]

    def _allowed(self) -> tuple[NamePair, ...]:
        pairs = self._allowed_by_rules()
        pairs += [(name, other) for name, held in self._held.items() for other in sorted(held.touches)]
        pairs += [(name, link) for name, released in self._let_go.items() for link in sorted(released.links)]
        return tuple(dict.fromkeys(pairs))

    def _reservations_before(self, arm: str) -> dict[str, tuple[Row, ...]]:
        before: dict[str, tuple[Row, ...]] = {}
        for name, rows in self._reservations.items():
            if name == arm:
                return before
            before[name] = rows
        return before

    def _solids_of(self, part: str) -> tuple[Solid, ...]:
        held = self._held.get(part)
        if held is not None:
            return held.part.solids
        for one in self._obstacles():
            if one.name == part:
                if part not in self._parts and part not in self._put:
                    raise _refused(f"{part} is a fixture and cannot be attached", "name a part")
                return one.solids
        raise _unknown("part", part, [*self._parts, *self._put])

    def _pose_of(self, part: str, measured: MeasuredPoses) -> RigidTransform:
        if part in measured.parts:
            return measured.parts[part]
        held = self._held.get(part)
        if held is not None:
            return measured.link(held.part.arm, held.link).then(RigidTransform.from_pose(held.part.pose))
        return RigidTransform.from_pose(self._put[part].pose)

    def _arm_names(self) -> frozenset[str]:
        return frozenset(arm.name for arm in self._base.arms)

    def _require_known(self, name: str) -> None:
        arm, slash, link = name.partition("/")
        if slash and arm in self._arm_names():
            known = link_names(self._base.arm(arm).placement.robot())
            if link not in known:
                raise _unknown(f"link of {arm}", link, sorted(known))
            return
        objects = {*self._arm_names(), *self._parts, *self._held, *(one.name for one in self._obstacles()), OCCUPANCY}
        if name not in objects:
            raise _unknown("object", name, sorted(objects))


def _refused(message: str, hint: str) -> SkillFailed:
    return SkillFailed(message, where="cell", hint=hint)


def _unknown(what: str, name: str, known: list[str]) -> SkillFailed:
    return SkillFailed(f"there is no {what} called {name}", where="cell", hint=did_you_mean(name, known))
