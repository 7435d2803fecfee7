"""One motion of an arm with a person's hand that gets into its path, in physics and virtual time."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Iterable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.intrusion_drawing import STEP_S, Intrusion, UndisturbedMotion
from engine.bus import GoalEnd, GoalHandle, GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import Cell
from engine.messages import JointState
from engine.messages.separation import SeparationState
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import JointTrapVel
from engine.skills.people import ContactCount, Reach, Withdraw
from engine.skills.planning import Adaptation, FreeMotionFeedback, FreeMotionResult, MotionTarget, MoveFree, PlanOptions
from robots.port import ArmSample, Array
from robots.scene.scene_builder import build_scene
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import CellModel, build_cell
from robots.sim.physics.physics import mujoco
from robots.sim.world.sim_world import SimWorld

MARGIN_M = 0.03
WAITS_S = 4.0
"""An arm that has waited so long before a hand that stays is done waiting for; then the hand is taken away."""

_BLIND = CollisionOptions(avoid=False)
_LOOK_S = 0.01
_MOVES_RAD_S = 0.01
_PATIENCE_S = 120.0
_LONGEST_S = 60.0
_HELD_UP_SHARE = 0.1


@dataclass(frozen=True, kw_only=True)
class IntrusionResult:
    """How a motion with an intrusion ended.

    `end` is `reached`, `waiting` before a hand that stayed, `failed`, or `stuck`: it did not get to its goal within a
    minute of the hand being gone again; `reason` says why it waits or failed. `in_motion` counts the contacts that
    started while the arm moved, the others started when the person moved into an arm at rest; `speed_m_s` is the
    greatest speed at which a body of the arm met the person. `stops` of a motion that waits or is stuck are at least
    as many.
    """

    end: str
    reason: str
    duration_s: float
    contacts: int
    in_motion: int
    greatest_force_n: float
    speed_m_s: float
    pairs: tuple[tuple[str, str], ...]
    stops: int = 0
    replans: int = 0
    reused: int = 0
    waited_s: float = 0.0


class IntrudedCell:
    """An open cell with one arm and people."""

    def __init__(
        self, cell: OpenCell, *, arm: str, people: tuple[str, ...], speed: float, body_speeds: BodySpeeds
    ) -> None:
        self.bus: SkillBus = cell.bus
        assert isinstance(cell.world, SimWorld)
        self._world = cell.world
        self.arm = arm
        self.body_speeds = body_speeds
        self._people = people
        self._speed = speed

    async def free(self, target: MotionTarget) -> tuple[float, ...]:
        """Go to a target with nobody in the way and return the joints there."""
        end = await self.bus.send_goal(self._free_goal(target), to=self.arm).result()
        assert end.result is not None, end.cause
        return end.result.joints

    async def recorded(self, goal: tuple[float, ...]) -> UndisturbedMotion:
        """Go to a goal with nobody in the way and return how."""
        start = tuple(self._joints().tolist())
        handle = self.bus.send_goal(self._free_goal(MotionTarget(joints=goal)), to=self.arm)
        await self._until_it_moves(handle)
        rows = [self._joints()]
        while not handle.finished:
            await self.bus.clock.sleep(STEP_S)
            rows.append(self._joints())
        end = await handle.result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        return UndisturbedMotion(start=start, goal=goal, joints=np.array(rows))

    async def stopping_s(self, undisturbed: UndisturbedMotion) -> float:
        """Return how long the arm takes to stop from half of a path, from where that path starts; it then goes it."""
        handle = self.bus.send_goal(
            JointTrapVel(joints=undisturbed.goal, speed=self._speed, collisions=_BLIND), to=self.arm
        )
        await self._until_it_moves(handle)
        await self.bus.clock.sleep(undisturbed.duration_s / 2.0)
        started_s = self.bus.clock.now_s()
        await handle.hold()
        stopped_s = self.bus.clock.now_s()
        await handle.resume()
        await handle.result()
        return stopped_s - started_s

    async def intruded(self, undisturbed: UndisturbedMotion, intrusion: Intrusion, *, adapts: bool) -> IntrusionResult:
        """Move along a path, monitoring it or not, while the hand gets into it; the hand is back at the end."""
        before = self._count(self._world.measured())
        handle = self._start(undisturbed, adapts=adapts)
        await self._until_it_moves(handle)
        started_s = self.bus.clock.now_s()
        watch = _Watch(self, before)
        watching = asyncio.create_task(watch.run(), name="counting contacts")
        try:
            await self.bus.clock.sleep(intrusion.after_s)
            reaching = await self.bus.call(
                Reach(
                    person=intrusion.person,
                    hand_m=intrusion.hand_m,
                    speed_m_s=intrusion.speed_m_s,
                    stay_s=intrusion.stay_s,
                ),
                to="cell",
            )
            arrives_s = self.bus.clock.now_s() + reaching.arrives_in_s
            ended = await self._outcome(handle, stays=intrusion.stay_s is None)
            duration_s = self.bus.clock.now_s() - started_s
            # A hand that is called back at full speed swings past where it was to stop.
            await self.bus.clock.sleep(max(0.0, arrives_s - self.bus.clock.now_s()))
            if not await self._cleared(handle, intrusion.person):
                ended = _so_far(handle.feedback, "stuck")
                handle.cancel()
                await handle.result()
        finally:
            watching.cancel()
            await asyncio.wait((watching,))
        after = self._count(self._world.measured())
        return IntrusionResult(
            **ended,
            duration_s=duration_s,
            contacts=after.contacts - before.contacts,
            in_motion=watch.in_motion,
            # A cell in which somebody was touched is not used again: nobody was before.
            greatest_force_n=after.greatest_force_n if after.contacts > before.contacts else 0.0,
            speed_m_s=watch.speed_m_s,
            pairs=tuple(pair for pair in after.pairs if pair not in before.pairs),
        )

    def _start(self, undisturbed: UndisturbedMotion, *, adapts: bool) -> GoalHandle[Any, Any]:
        if adapts:
            return self.bus.send_goal(self._free_goal(MotionTarget(joints=undisturbed.goal)), to=self.arm)
        blind = JointTrapVel(joints=undisturbed.goal, speed=self._speed, collisions=_BLIND)
        return self.bus.send_goal(blind, to=self.arm)

    def _free_goal(self, target: MotionTarget) -> MoveFree:
        return MoveFree(
            target=target,
            options=PlanOptions(speed=self._speed, margin_m=MARGIN_M),
            adaptation=Adaptation(patience_s=_PATIENCE_S),
        )

    async def _outcome(self, handle: GoalHandle[Any, Any], *, stays: bool) -> dict[str, Any]:
        """Wait for the end, or until the arm has waited for long enough before a hand that stays."""
        started_s, waiting_since_s = self.bus.clock.now_s(), None
        while not handle.finished:
            await self.bus.clock.sleep(_LOOK_S)
            now_s, feedback = self.bus.clock.now_s(), handle.feedback
            waits = isinstance(feedback, FreeMotionFeedback) and feedback.phase in ("waiting", "planning")
            waits = waits or self._is_held_up()
            waiting_since_s = (waiting_since_s or now_s) if waits else None
            if stays and waiting_since_s is not None and now_s - waiting_since_s > WAITS_S:
                return _so_far(feedback, "waiting")
            if now_s - started_s > _LONGEST_S:
                return {"end": "failed", "reason": f"no end after {_LONGEST_S:g} s"}
        return _ended(await handle.result())

    def _is_held_up(self) -> bool:
        """Return whether separation monitoring permits hardly any speed."""
        state = self.bus.topic(f"{self.arm}/separation", SeparationState).latest
        return state is not None and state.monitoring and state.permitted_share < _HELD_UP_SHARE

    async def _cleared(self, handle: GoalHandle[Any, Any], person: str) -> bool:
        """Take the hand away and let the arm go on to its goal; false when it does not get there."""
        back = await self.bus.call(Withdraw(person=person), to="cell")
        await self.bus.clock.sleep(back.arrives_in_s + 0.1)
        until_s = self.bus.clock.now_s() + _LONGEST_S
        while not handle.finished and self.bus.clock.now_s() < until_s:
            await self.bus.clock.sleep(_LOOK_S)
        return handle.finished

    async def _until_it_moves(self, handle: GoalHandle[Any, Any]) -> None:
        await handle.accepted()
        while self.speed_rad_s() < _MOVES_RAD_S and not handle.finished:
            await self.bus.clock.sleep(_LOOK_S)

    def speed_rad_s(self) -> float:
        """Return the speed of the fastest joint."""
        return _fastest_rad_s(self._state())

    def _count(self, snapshot: SimSnapshot) -> ContactCount:
        """Return the counts of all people together."""
        counts = [snapshot.person(person).count for person in self._people]
        return ContactCount(
            contacts=sum(count.contacts for count in counts),
            touching_s=sum(count.touching_s for count in counts),
            greatest_force_n=max(count.greatest_force_n for count in counts),
            pairs=tuple(pair for count in counts for pair in count.pairs),
        )

    def _joints(self) -> Array:
        return np.array(self._state().position_rad)

    def _state(self) -> JointState:
        state = self.bus.topic(f"{self.arm}/joint_state", JointState).latest
        assert state is not None
        return state

    def look(self) -> tuple[ArmSample, ContactCount]:
        """Return the state of the arm and the count of contacts."""
        snapshot = self._world.measured()
        return snapshot.arm(self.arm), self._count(snapshot)


class BodySpeeds:
    """The speeds of the bodies of the one arm of a cell."""

    def __init__(self, cell: CellModel) -> None:
        self._model, self._data = cell.model, mujoco.MjData(cell.model)
        (self._arm,) = cell.arms
        self._numbers = {cell.body_names[body]: body for body in self._arm.bodies}

    def fastest_m_s(self, state: ArmSample, bodies: Iterable[str]) -> float:
        """Return the speed of the fastest of these bodies at its centre of mass; 0 where none is of the arm."""
        model, data = self._model, self._data
        data.qpos[self._arm.qpos] = state.position_rad
        data.qvel[self._arm.dof] = state.velocity_rad_s
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        twist = np.zeros(6)
        speeds = [0.0]
        for body in bodies:
            if body in self._numbers:
                mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, self._numbers[body], twist, 0)
                speeds.append(float(np.linalg.norm(twist[3:])))
        return max(speeds)


class _Watch:
    """Distinguishes contacts of an arm in motion from those of one at rest.

    What counts is how fast the arm was before anything touched it: a person who walks into an arm at rest moves it.
    """

    def __init__(self, cell: IntrudedCell, before: ContactCount) -> None:
        self._cell = cell
        self._count = before
        self.in_motion = 0
        self.speed_m_s = 0.0

    async def run(self) -> None:
        """Look every 10 ms, until cancelled."""
        untouched, _ = self._cell.look()
        while True:
            await self._cell.bus.clock.sleep(_LOOK_S)
            state, count = self._cell.look()
            started = count.contacts - self._count.contacts
            if started > 0:
                self.in_motion += started * (_fastest_rad_s(untouched) > _MOVES_RAD_S)
                touched = [other for _, other in count.pairs]
                self.speed_m_s = max(self.speed_m_s, self._cell.body_speeds.fastest_m_s(untouched, touched))
            if count.touching_s == self._count.touching_s:
                untouched = state
            self._count = count


def _fastest_rad_s(state: ArmSample | JointState) -> float:
    return float(np.abs(state.velocity_rad_s).max())


def _so_far(feedback: object, end: str) -> dict[str, Any]:
    if not isinstance(feedback, FreeMotionFeedback):
        return {"end": end, "reason": ""}
    # Each other way was found at a stop, and the one that it stands at now has led to none.
    return {
        "end": end,
        "reason": feedback.reason,
        "stops": feedback.replans + 1,
        "replans": feedback.replans,
        "waited_s": feedback.waited_s,
    }


def _ended(end: GoalEnd[Any]) -> dict[str, Any]:
    if end.status is not GoalStatus.SUCCEEDED:
        return {"end": "failed", "reason": str(end.cause)}
    result = end.result
    if not isinstance(result, FreeMotionResult):
        return {"end": "reached", "reason": ""}
    if result.blocked:
        return {"end": "failed", "reason": result.blocked}
    return {
        "end": "reached",
        "reason": "",
        "stops": result.stops,
        "replans": result.replans,
        "reused": result.reused,
        "waited_s": result.waited_s,
    }


@asynccontextmanager
async def intruded_cell(document: Cell, *, speed: float) -> AsyncGenerator[IntrudedCell]:
    """Open a cell of one arm and people, with a store of its own."""
    (arm,), people = document.document.robots, tuple(document.document.people)
    with TemporaryDirectory() as folder:
        async with OpenCell(document, store_path=str(Path(folder) / "store.db")) as cell:
            body_speeds = BodySpeeds(build_cell(build_scene(document.document)))
            yield IntrudedCell(cell, arm=arm, people=people, speed=speed, body_speeds=body_speeds)
