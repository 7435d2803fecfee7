"""The guarded move: a straight line that ends at a contact force."""

from __future__ import annotations

import math

import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import GoalRejected
from engine.skills.contact import ContactResult, MoveUntilContact
from engine.skills.motion import CartMotionFeedback
from robots.arm.execution.given_path import given_path
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.tool_frames import WORLD
from robots.arm.execution.trajectory_goal import publish_pose_feedback
from robots.control.generators.guarded_motion import decode_peak_n
from robots.model.mechanics.dynamics import ArmDynamics, Payload
from robots.model.transform import RigidTransform
from robots.motion import plan_line
from robots.motion.min_jerk import PEAK_SPEED
from robots.motion.speed_profile import MIN_JERK, SpeedProfile, plan_approach
from robots.motion.touch_speed import effective_mass_kg, friction_push_n, touch_speed_m_s
from robots.port import Array, ContactCondition, JointTrajectory, Motion
from robots.port.wrench import to_wrench

_NO_DIRECTION = 1e-6
# A hundredth of a millimetre a second: slower, a centimetre takes more than a quarter of an hour.
_SLOWEST_TOUCH_M_S = 1e-5


class ContactMotions:
    """Serves MoveUntilContact."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the skill under the arm's name."""
        name = self._runner.name
        bus.advertise_action(MoveUntilContact, self._until_contact, namespace=name, exclusive=name)

    async def _until_contact(self, goal: MoveUntilContact, handle: ActiveGoal[CartMotionFeedback]) -> ContactResult:
        runner = self._runner
        runner.require_ready(handle)
        start = runner.kinematics.tool_pose(runner.port.sample().desired_rad)
        direction = self._direction(goal, start, handle)
        if not math.isfinite(goal.distance_m):
            raise GoalRejected(f"{goal.distance_m} m is not a distance", where=handle.address, hint="`distance_m: 0.1`")
        end = RigidTransform(xyz=start.xyz + goal.distance_m * direction, xyzw=start.xyzw)
        profile, duration_s = self._profile(goal, direction, handle)
        async with given_path(runner, goal.collisions, tool_contact="ends_path") as path:
            trajectory = await path.planned(
                handle,
                lambda joints: runner.planner.make(
                    lambda kinematics: plan_line(kinematics, joints, end, duration_s=duration_s, profile=profile)
                ),
            )
            before = runner.measured_tool()
            ended = await runner.carry_out(
                lambda: path.monitored(self._follow(trajectory, goal.force_n, direction)),
                handle,
                lambda motion: publish_pose_feedback(runner, handle, motion),
            )
        measured, wrench = runner.measured_tool(), runner.port.sample().wrench
        return ContactResult(
            contact=ended.report.contact,
            pose=measured.to_pose(WORLD),
            travelled_m=float((measured.xyz - before.xyz) @ direction),
            force_n=float(-wrench[:3] @ direction),
            wrench=to_wrench(wrench),
            duration_s=ended.duration_s,
            peak_n=decode_peak_n(ended.report.data) if ended.report.data else 0.0,
        )

    def _profile(
        self, goal: MoveUntilContact, direction: Array, handle: ActiveGoal[CartMotionFeedback]
    ) -> tuple[SpeedProfile, float]:
        """Return the speed along the line and its time, s."""
        if goal.peak_n is None:
            return MIN_JERK, PEAK_SPEED * goal.distance_m / goal.speed_m_s
        if goal.peak_n < goal.force_n:
            raise GoalRejected(
                f"a peak of {goal.peak_n:g} N is less than the contact force of {goal.force_n:g} N",
                where=handle.address,
                hint="lower `force_n` or raise `peak_n`",
            )
        runner = self._runner
        friction_n = friction_push_n(runner.kinematics, runner.port.sample().desired_rad, direction)
        if friction_n >= goal.peak_n:
            raise GoalRejected(
                f"a peak of {goal.peak_n:g} N is not possible here: what compensates the friction of the joints alone "
                f"pushes with {friction_n:.1f} N along the direction",
                where=handle.address,
                hint="raise `peak_n`, or begin where the joints move less for the same path",
            )
        touch_m_s = touch_speed_m_s(
            self._mass_kg(direction), peak_n=goal.peak_n, surface_n_m=goal.surface_n_m, friction_n=friction_n
        )
        if not touch_m_s >= _SLOWEST_TOUCH_M_S:
            raise GoalRejected(
                f"a peak of {goal.peak_n:g} N on a surface of {goal.surface_n_m:g} N/m is a touch at "
                f"{touch_m_s:.2g} m/s, slower than {_SLOWEST_TOUCH_M_S:g} m/s",
                where=handle.address,
                hint="raise `peak_n`, or lower `surface_n_m`",
            )
        return plan_approach(
            goal.distance_m,
            clear_m=min(goal.clear_m, goal.distance_m),
            speed_m_s=goal.speed_m_s,
            touch_m_s=min(goal.speed_m_s, touch_m_s),
        )

    def _mass_kg(self, direction: Array) -> float:
        """Return the effective mass of arm, tool and load along `direction`."""
        runner, settings = self._runner, self._runner.port.settings
        load = Payload(mass_kg=settings.load_kg, com_m=settings.load_com_m) if settings.load_kg > 0.0 else None
        dynamics = ArmDynamics(runner.model, load=load)
        return effective_mass_kg(dynamics, runner.kinematics, runner.port.sample().desired_rad, direction)

    def _direction(self, goal: MoveUntilContact, tool: RigidTransform, handle: ActiveGoal[CartMotionFeedback]) -> Array:
        """Return the unit vector of the motion in the world, (3,)."""
        length = math.hypot(*goal.direction)
        if not math.isfinite(length) or length < _NO_DIRECTION:
            raise GoalRejected(
                f"{goal.direction} is not a direction", where=handle.address, hint="[0, 0, -1] points down in the world"
            )
        return self._runner.frames.axes(goal.frame, tool=tool) @ (np.array(goal.direction) / length)

    def _follow(self, trajectory: JointTrajectory, force_n: float, direction: Array) -> Motion:
        runner = self._runner
        x, y, z = (-direction).tolist()
        until = ContactCondition(force_n=force_n, direction=(x, y, z))
        return runner.port.follow(trajectory, tolerance=runner.tolerance, until=until)
