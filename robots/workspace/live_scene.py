"""The planning scene of a cell as it is now: what is known of it, what was put into it, what is measured."""

from __future__ import annotations

import logging
from collections.abc import Collection
from dataclasses import replace

import msgspec

from engine.errors import SkillFailed
from engine.messages.shapes import Obstacle, Solid
from engine.skills.planning_scene import HeldPart, PlanningSceneState
from engine.suggestions import did_you_mean
from robots.model.link_names import link_names
from robots.model.transform import RigidTransform
from robots.planning.scene.planning_scene import AttachedPart, NamePair, PlanningScene, SceneArm
from robots.workspace.grasped_parts import GraspedPart, GraspedPartMemo, ReleasedPart, ReleasedPartMemo
from robots.workspace.measured_poses import MeasuredPoses, PoseSource
from robots.workspace.obstacle_validation import find_obstacle_fault
from robots.workspace.path_reservations import Row, with_reservations
from robots.workspace.proximity import SEPARATED_M, TOUCHING_M, links_near_part, names_near_held_part
from robots.workspace.tracked_objects import TrackedObjects

OCCUPANCY = "occupancy"
"""The name of what cameras see and nobody knows."""

_log = logging.getLogger("flexcell.workspace")


class SceneMemo(msgspec.Struct, frozen=True, kw_only=True):
    """What of a scene is neither in the cell document nor measured."""

    put: tuple[Obstacle, ...] = ()
    removed: tuple[str, ...] = ()
    rules: tuple[tuple[str, str, bool], ...] = ()
    held: tuple[GraspedPartMemo, ...] = ()
    let_go: tuple[ReleasedPartMemo, ...] = ()


class LiveScene:
    """Changes only by its methods; `refresh` takes in what is measured.

    Args:
        base: The cell as its document has it.
        parts: The names of its parts, which are where they are measured.
        look: How to look at the cell.

    All methods that name something raise SkillFailed where it is not there, or may not be changed so.
    """

    def __init__(self, base: PlanningScene, *, parts: Collection[str], look: PoseSource) -> None:
        self._base = base
        self._parts = frozenset(parts)
        self._look = look
        self._things = TrackedObjects()
        self._put: dict[str, Obstacle] = {}
        self._removed: set[str] = set()
        self._rules: dict[frozenset[str], tuple[str, str, bool]] = {}
        self._held: dict[str, GraspedPart] = {}
        self._let_go: dict[str, ReleasedPart] = {}
        self._claims: dict[str, tuple[Row, ...]] = {}
        self.revision = 0

    @property
    def arms(self) -> int:
        """How many arms there are."""
        return len(self._base.arms)

    def refresh(self) -> frozenset[str]:
        """Take in what is measured; returns the names of parts, held parts and arms that have changed."""
        seen = self._look()
        parts, arms = self._things.take(seen)
        changed = {name for name in parts if name not in self._held}
        for name, held in tuple(self._held.items()):
            if self._followed(name, held, seen):
                changed.add(name)
        if changed:
            self.revision += 1
        if parts or arms:
            self._part_ways()
        return frozenset(changed | arms)

    def scene_for(self, arm: str) -> PlanningScene:
        """Return the scene as `arm` meets it: other arms where they are noticed, and on the ways they have claimed.

        Of itself it says nothing that changes as the arm moves, so that it stays the same meanwhile.
        """
        scene = self.whole()
        own = msgspec.structs.replace(scene.arm(arm), joints_rad=())
        scene = msgspec.structs.replace(scene, arms=tuple(own if a.name == arm else a for a in scene.arms))
        return with_reservations(scene, self._claims_before(arm))

    def holds(self, arm: str) -> bool:
        """Return whether an arm held something when it was looked at last."""
        return any(one.part.arm == arm for one in self._held.values())

    def lies(self, arm: str) -> bool:
        """Return whether something that an arm held has not yet parted from what it was taken from."""
        return any(one.part.arm == arm and one.touches for one in self._held.values())

    def attached_check_scene_for(self, arm: str) -> PlanningScene | None:
        """Return the scene as what `arm` holds meets it, None where it holds nothing.

        What the held parts lie on is not allowed in it: that is for who knows where they are to go.
        """
        if not self.holds(arm):
            return None
        held = {name: one for name, one in self._held.items() if one.part.arm == arm}
        lying = {(name, other) for name, one in held.items() for other in one.touches}.difference(self._ruled())
        scene = self.scene_for(arm)
        return msgspec.structs.replace(scene, allowed=tuple(pair for pair in scene.allowed if pair not in lying))

    def whole(self) -> PlanningScene:
        """Return the scene with all arms where they are noticed."""
        things = self._things
        arms = tuple(
            SceneArm(placement=a.placement, joints_rad=now.joints_rad, tool_joints=now.tool_joints)
            if (now := things.arms.get(a.name)) is not None
            else a
            for a in self._base.arms
        )
        return PlanningScene(arms=arms, obstacles=self._obstacles(), attached=self._attached(), allowed=self._allowed())

    def state(self) -> PlanningSceneState:
        """Return the scene as the bus knows it."""
        held = tuple(
            HeldPart(name=p.name, robot=p.arm, link=one.link, solids=p.solids, pose=p.pose)
            for one in self._held.values()
            for p in (one.part,)
        )
        return PlanningSceneState(
            revision=self.revision, obstacles=self._obstacles(), held=held, allowed=self._allowed()
        )

    def put(self, obstacle: Obstacle) -> None:
        """Put an obstacle, or another one in the place of that of its name."""
        name = obstacle.name
        if fault := find_obstacle_fault(obstacle):
            raise _refused(fault, "give shapes with sizes in metres, at a pose in the world")
        if name in self._parts or name in self._held:
            raise _refused(f"{name} is a part, which is where it is measured", "give the obstacle another name")
        if name == OCCUPANCY or name.partition("/")[0] in self._arm_names() or "~" in name:
            raise _refused(f"an obstacle cannot be called {name}", "give it another name")
        self._put[name] = obstacle
        self._removed.discard(name)
        self.revision += 1

    def remove(self, name: str) -> None:
        """Take an obstacle out; one that was taken out before is no error."""
        if name in self._removed:
            return
        if name in self._parts or name in self._held:
            raise _refused(f"{name} is a part, which is where it is measured", "allow what it may touch, or attach it")
        if name not in {one.name for one in self._obstacles()}:
            raise _unknown("obstacle", name, [one.name for one in self._obstacles()])
        self._put.pop(name, None)
        self._removed.add(name)
        self.revision += 1

    def allow(self, first: str, second: str, *, allowed: bool) -> None:
        """Say whether two things may touch."""
        for name in (first, second):
            self._require_known(name)
        self._rules[frozenset((first, second))] = (first, second, allowed)
        self.revision += 1

    def attach(self, part: str, arm: str, link: str) -> None:
        """Let a part move with a link of an arm (the tool link where `link` is empty), from where it is."""
        if arm not in self._arm_names():
            raise _unknown("arm", arm, sorted(self._arm_names()))
        model = self._base.arm(arm).placement.robot()
        frame = link or model.tool_link
        if frame not in link_names(model):
            raise _unknown(f"link of {arm}", frame, sorted(link_names(model)))
        before = self._held.get(part)
        if before is not None and (before.part.arm, before.link) == (arm, frame):
            return
        seen = self._look()
        self._things.take(seen)
        solids = self._solids_of(part)
        at = seen.link(arm, frame).inverse().then(self._place_of(part, seen))
        attached = AttachedPart(name=part, arm=arm, solids=solids, pose=at.to_pose(frame), link=link)
        self._put.pop(part, None)
        self._let_go.pop(part, None)
        self._held[part] = GraspedPart(part=attached, link=frame, taken=at, touches=frozenset())
        touches = names_near_held_part(self._measured(seen), part, within_m=TOUCHING_M)
        self._held[part] = replace(self._held[part], touches=touches)
        self.revision += 1
        _log.info("%s holds %s%s", arm, part, f", which touches {', '.join(sorted(touches))}" if touches else "")

    def detach(self, part: str) -> None:
        """Let go of a part; one that nobody holds is no error."""
        if part not in self._held:
            self._require_known(part)
            return
        self._drop(part, self._look())
        self.revision += 1

    def claim(self, arm: str, rows: tuple[Row, ...]) -> None:
        """Say where an arm on its way will be; others keep out of that from now on, but for those who claimed before.

        Empty gives the claim back.
        """
        if rows:
            self._claims[arm] = rows
        else:
            self._claims.pop(arm, None)

    def memo(self) -> SceneMemo:
        """Return what must be known again after a restore."""
        return SceneMemo(
            put=tuple(self._put.values()),
            removed=tuple(sorted(self._removed)),
            rules=tuple(self._rules.values()),
            held=tuple(GraspedPartMemo.of(one) for one in self._held.values()),
            let_go=tuple(
                ReleasedPartMemo(part=name, arm=one.arm, links=tuple(sorted(one.links)))
                for name, one in self._let_go.items()
            ),
        )

    def remember(self, memo: SceneMemo) -> None:
        """Be as `memo` says, from now on."""
        self._put = {one.name: one for one in memo.put}
        self._removed = set(memo.removed)
        self._rules = {frozenset(rule[:2]): rule for rule in memo.rules}
        self._held = {one.part.name: one.held() for one in memo.held}
        self._let_go = {one.part: ReleasedPart(arm=one.arm, links=frozenset(one.links)) for one in memo.let_go}
        self._claims.clear()
        self.revision += 1

    def _followed(self, name: str, held: GraspedPart, seen: MeasuredPoses) -> bool:
        """Look where a held part is in the hand; true where that, or that it is held, has changed."""
        if name not in seen.parts:
            return False
        now = held.slipped_to(seen.link(held.part.arm, held.link).inverse().then(seen.parts[name]))
        if now is held:
            return False
        if now is None:
            _log.warning("%s has lost %s; it lies where it is seen", held.part.arm, name)
            self._drop(name, seen)
        else:
            self._held[name] = now
        return True

    def _drop(self, name: str, seen: MeasuredPoses) -> None:
        held = self._held.pop(name)
        if name not in self._parts:
            at = seen.link(held.part.arm, held.link).then(RigidTransform.from_pose(held.part.pose))
            self._put[name] = Obstacle(name=name, solids=held.part.solids, pose=at.to_pose("world"))
        self._things.take(seen)
        links = links_near_part(self._measured(seen), name, held.part.arm, within_m=SEPARATED_M)
        if links:
            self._let_go[name] = ReleasedPart(arm=held.part.arm, links=links)

    def _part_ways(self) -> None:
        """Allow no more touching to what has parted."""
        scene = self.whole()
        for name, held in tuple(self._held.items()):
            if held.touches:
                near = names_near_held_part(scene, name, within_m=SEPARATED_M, among=held.touches)
                self._held[name] = replace(held, touches=held.touches & near)
        for name, gone in tuple(self._let_go.items()):
            links = gone.links & links_near_part(scene, name, gone.arm, within_m=SEPARATED_M)
            if links:
                self._let_go[name] = replace(gone, links=links)
            else:
                del self._let_go[name]

    def _measured(self, seen: MeasuredPoses) -> PlanningScene:
        """Return the scene with the arms exactly where they are seen."""
        scene = self.whole()
        for name, arm in seen.arms.items():
            scene = scene.with_joints(name, arm.joints_rad, tool_joints=dict(arm.tool_joints))
        return scene

    def _obstacles(self) -> tuple[Obstacle, ...]:
        found: list[Obstacle] = []
        for one in self._base.obstacles:
            if one.name in self._held or one.name in self._put or one.name in self._removed:
                continue
            lying = self._things.parts.get(one.name) if one.name in self._parts else None
            found.append(one if lying is None else msgspec.structs.replace(one, pose=lying))
        return (*found, *self._put.values())

    def _attached(self) -> tuple[AttachedPart, ...]:
        return tuple(one.part for one in self._held.values())

    def _ruled(self) -> list[NamePair]:
        pairs = [pair for pair in self._base.allowed if frozenset(pair) not in self._rules]
        return pairs + [(first, second) for first, second, allowed in self._rules.values() if allowed]

    def _allowed(self) -> tuple[NamePair, ...]:
        pairs = self._ruled()
        pairs += [(name, other) for name, held in self._held.items() for other in sorted(held.touches)]
        pairs += [(name, link) for name, gone in self._let_go.items() for link in sorted(gone.links)]
        return tuple(dict.fromkeys(pairs))

    def _claims_before(self, arm: str) -> dict[str, tuple[Row, ...]]:
        before: dict[str, tuple[Row, ...]] = {}
        for name, rows in self._claims.items():
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
                    raise _refused(f"{part} is a fixture, which nobody carries", "name a part")
                return one.solids
        raise _unknown("part", part, [*self._parts, *self._put])

    def _place_of(self, part: str, seen: MeasuredPoses) -> RigidTransform:
        if part in seen.parts:
            return seen.parts[part]
        held = self._held.get(part)
        if held is not None:
            return seen.link(held.part.arm, held.link).then(RigidTransform.from_pose(held.part.pose))
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
        things = {*self._arm_names(), *self._parts, *self._held, *(one.name for one in self._obstacles()), OCCUPANCY}
        if name not in things:
            raise _unknown("thing", name, sorted(things))


def _refused(message: str, hint: str) -> SkillFailed:
    return SkillFailed(message, where="cell", hint=hint)


def _unknown(what: str, name: str, known: list[str]) -> SkillFailed:
    return SkillFailed(f"there is no {what} called {name}", where="cell", hint=did_you_mean(name, known))
