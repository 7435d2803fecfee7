"""Serves IdentifyPayload and IdentifyFriction: an exciting motion, its samples, and the estimate."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import GoalRejected, RobotError, SkillFailed
from engine.skills.collision_options import CollisionOptions
from engine.skills.identification import (
    FrictionEstimate,
    IdentificationFeedback,
    IdentifyFriction,
    IdentifyPayload,
    JointFrictionEstimate,
    PayloadEstimate,
)
from robots.arm.execution.given_path import given_path
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.identification.excitation import swing_joints, swing_wrist
from robots.arm.identification.friction_regression import estimate_friction, moves
from robots.arm.identification.motion_samples import MotionSamples
from robots.arm.identification.payload_regression import WristSamples, estimate_payload
from robots.model.mechanics.dynamics import GRAVITY_M_S2, ArmDynamics, Payload
from robots.model.transform import RigidTransform
from robots.port import Array, JointTrajectory, Motion

_AT_LINK = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
_GRAVITY = np.array([0.0, 0.0, -GRAVITY_M_S2])


class IdentificationMotions:
    """Serves IdentifyPayload and IdentifyFriction."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills under the arm's name."""
        name = self._runner.name
        bus.advertise_action(IdentifyPayload, self._payload, namespace=name, exclusive=name)
        bus.advertise_action(IdentifyFriction, self._friction, namespace=name, exclusive=name)

    async def _payload(self, goal: IdentifyPayload, handle: ActiveGoal[IdentificationFeedback]) -> PayloadEstimate:
        model, settings = self._runner.model, self._runner.port.settings
        samples = await self._excited(
            handle,
            goal.collisions,
            lambda start: swing_wrist(
                start, amplitude_rad=goal.amplitude_rad, limits=model.limits, joints=model.arm_joints
            ),
        )
        try:
            return estimate_payload(self._at_wrist(samples), set_kg=settings.load_kg, set_com_m=settings.load_com_m)
        except RobotError as error:
            raise SkillFailed(error.message, where=handle.address, hint=error.hint) from None

    async def _friction(self, goal: IdentifyFriction, handle: ActiveGoal[IdentificationFeedback]) -> FrictionEstimate:
        model = self._runner.model
        unknown = [joint for joint in goal.joints if joint not in model.arm_joints]
        if unknown:
            raise GoalRejected(
                f"the arm has no joint {unknown[0]}",
                where=handle.address,
                hint="it has " + ", ".join(model.arm_joints),
            )
        moved = [at for at, joint in enumerate(model.arm_joints) if not goal.joints or joint in goal.joints]
        samples = await self._excited(
            handle,
            goal.collisions,
            lambda start: swing_joints(
                start, moved, amplitude_rad=goal.amplitude_rad, limits=model.limits, joints=model.arm_joints
            ),
        )
        return FrictionEstimate(joints=self._frictions(samples, moved, handle), samples=samples.count)

    async def _excited(
        self,
        handle: ActiveGoal[IdentificationFeedback],
        collisions: CollisionOptions,
        excite: Callable[[Array], JointTrajectory],
    ) -> MotionSamples:
        """Execute an exciting motion and return its samples."""
        runner = self._runner

        async def plan(start: Array) -> JointTrajectory:
            return excite(start)

        samples = MotionSamples(runner, handle)
        sampling: list[asyncio.Task[None]] = []

        def publish_feedback(motion: Motion) -> None:
            handle.feedback(IdentificationFeedback(joints=runner.measured(), progress=motion.progress))

        async with given_path(runner, collisions, timing="fixed") as path:
            trajectory = await path.planned(handle, plan)

            def start() -> Motion:
                sampling.append(asyncio.create_task(samples.run(), name=f"identification on {runner.name}"))
                return path.monitored(runner.port.follow(trajectory, tolerance=runner.tolerance))

            try:
                await runner.carry_out(start, handle, publish_feedback)
            finally:
                for task in sampling:
                    task.cancel()
                    await asyncio.wait((task,))
        return samples

    def _at_wrist(self, samples: MotionSamples) -> WristSamples:
        """Return the measured wrenches about the tool link and in its axes, with gravity less acceleration."""
        kinematics, settings = self._runner.kinematics.with_tool(_AT_LINK), self._runner.port.settings
        lever_m = np.array(settings.tool_xyz_m)
        # Positions of the set point have no noise to differentiate.
        origins = np.array([kinematics.tool_pose(joints).xyz for joints in samples.set_point_rad])
        falling = _GRAVITY - samples.rate_of(samples.rate_of(origins))
        forces: list[Array] = []
        torques: list[Array] = []
        fallings: list[Array] = []
        for joints, wrench, g in zip(samples.position_rad, samples.wrench, falling, strict=True):
            axes = kinematics.tool_pose(joints).rotation
            force = axes.T @ wrench[:3]
            forces.append(force)
            torques.append(axes.T @ wrench[3:] + np.cross(lever_m, force))
            fallings.append(axes.T @ g)
        return WristSamples(force_n=np.array(forces), torque_nm=np.array(torques), falling_m_s2=np.array(fallings))

    def _frictions(
        self, samples: MotionSamples, moved: list[int], handle: ActiveGoal[IdentificationFeedback]
    ) -> tuple[JointFrictionEstimate, ...]:
        runner = self._runner
        settings, names = runner.port.settings, runner.model.arm_joints
        load = Payload(mass_kg=settings.load_kg, com_m=settings.load_com_m) if settings.load_kg > 0.0 else None
        dynamics = ArmDynamics(runner.model, base=runner.frames.base, load=load)
        position = samples.set_point_rad
        velocity = samples.rate_of(position)
        acceleration = samples.rate_of(velocity)
        nominal = np.array([dynamics.torque(q, v, a) for q, v, a in zip(position, velocity, acceleration, strict=True)])
        excess = samples.effort_nm - nominal - dynamics.damping_nms_rad * velocity
        found: list[JointFrictionEstimate] = []
        for at in moved:
            if not moves(velocity[:, at]):
                raise SkillFailed(
                    f"{names[at]} moved too little to measure its friction",
                    where=handle.address,
                    hint="give a larger amplitude_rad, or a higher speed override",
                )
            moving = np.abs(velocity[:, at]) > 0.0
            found.append(
                estimate_friction(
                    names[at],
                    excess_nm=excess[moving, at],
                    position_rad=position[moving, at],
                    velocity_rad_s=velocity[moving, at],
                    acceleration_rad_s2=acceleration[moving, at],
                )
            )
        return tuple(found)
