"""An arm that plans one and the same way, and a state that asks it to; beside everything else there is to see."""

from __future__ import annotations

from typing import ClassVar, Literal

from engine.bus import ActiveGoal, SkillBus
from engine.messages import FramePoses, RobotDescription, SceneDescription
from engine.messages.sensing import CameraInfo, DepthImage, OccupancyGrid
from engine.skills.planning import MotionTarget, PathPreview, PlanFeedback, PlanMotion, PlannedMotion
from engine.skills.planning_scene import PlanningSceneState
from engine.state import Context, Outcome, State
from tests.editor_web.fake_sights import (
    camera,
    depth,
    description,
    frames_with_a_person,
    occupancy,
    planned_path,
    planning_scene,
    scene_with_a_person,
)

CONFIRMED_ID = "behaviors/confirmed.yaml"
CONFIRMED = """
flexcell: 1
name: confirmed
description: A way is planned, shown and agreed to before anything moves.
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: plan
    states:
      plan: {state: test.Plan, autonomy: {planned: high}, transitions: {planned: good, no_way: bad}}
"""


class Plan(State, frozen=True, kw_only=True):
    """Let the left arm plan."""

    state_name: ClassVar[str] = "test.Plan"
    outcomes: ClassVar[tuple[str, ...]] = ("planned", "no_way")

    async def run(self, ctx: Context) -> Outcome:
        end = await ctx.perform(PlanMotion(target=MotionTarget(joints=(0.0, 0.0, 0.0))), to="left")
        return Outcome("planned" if end.status == "succeeded" else "no_way")


class FakePlanner:
    """Answers for the left arm; `show` says how its way stands."""

    def __init__(self, bus: SkillBus) -> None:
        self._previews = bus.topic("left/planned_path", PathPreview)
        self._previews.publish(planned_path("left", "none"))
        for arm in ("left", "right"):
            bus.topic(f"{arm}/description", RobotDescription).publish(description(arm))
        bus.topic("cell/scene", SceneDescription).publish(scene_with_a_person())
        bus.topic("cell/frames", FramePoses).publish(frames_with_a_person(0.0))
        bus.topic("cell/planning_scene", PlanningSceneState).publish(planning_scene())
        bus.topic("cell/occupancy", OccupancyGrid).publish(occupancy())
        bus.topic("above/camera_info", CameraInfo).publish(camera())
        bus.topic("above/depth", DepthImage).publish(depth())
        bus.advertise_action(PlanMotion, self._plan, namespace="left")

    def show(self, state: Literal["none", "proposed", "moving", "blocked"], *, reason: str = "") -> None:
        """Let the way stand so."""
        self._previews.publish(planned_path("left", state, reason=reason))

    async def _plan(self, goal: PlanMotion, handle: ActiveGoal[PlanFeedback]) -> PlannedMotion:
        del goal
        handle.accept()
        found = planned_path("left")
        self._previews.publish(found)
        return PlannedMotion(
            robot="left",
            waypoints=found.joints,
            speed=0.3,
            duration_s=3.25,
            tool_path=found.tool_path,
            found_by="RRTConnect",
            planning_s=0.124,
        )
