"""CartAdmitDMP: follows a Cartesian primitive with a desired force and learns the offsets of each pass (RCL 4.3.7)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.messages.primitives import CartOffsets
from engine.skills.dmp import CartAdmitDMP, CartAdmitFeedback, CartAdmitResult
from robots.arm.dmp_motions import frame_of
from robots.arm.execution.given_path import given_path
from robots.arm.execution.motion_runner import MotionRunner
from robots.model.mechanics.kinematics import ArmKinematics
from robots.motion.dmp import no_offsets, offsets_at, offsets_from_samples, phase_at, plan_cart_dmp, wrench_at
from robots.motion.dmp.quaternions import of_matrix
from robots.port import Array, ForceRecord, ForceTask, Motion
from robots.port.wrench import to_wrench


@dataclass(frozen=True, kw_only=True)
class _Errors:
    rms_n: float
    max_n: float


class ForceMotions:
    """Serves CartAdmitDMP."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the skill under the arm's name."""
        name = self._runner.name
        bus.advertise_action(CartAdmitDMP, self._cart_admit_dmp, namespace=name, exclusive=name)

    async def _cart_admit_dmp(self, goal: CartAdmitDMP, handle: ActiveGoal[CartAdmitFeedback]) -> CartAdmitResult:
        runner = self._runner
        frame = frame_of(runner, goal.dmp, handle)

        def plan(kinematics: ArmKinematics, start: Array) -> ForceTask:
            trajectory = plan_cart_dmp(
                kinematics,
                goal.dmp,
                start,
                frame=frame,
                start_reach_m=goal.start_reach_m,
                start_reach_rad=goal.start_reach_rad,
            )
            axes = runner.frames.axes(goal.compliance.frame, tool=kinematics.tool_pose(start))
            x, y, z, w = of_matrix(axes).tolist()
            duration_s = trajectory.duration_s
            phase = phase_at(np.linspace(0.0, duration_s / goal.dmp.tau, len(trajectory.position_rad)), goal.dmp.a_x)
            reach = np.array([goal.compliance.reach_m] * 3 + [goal.compliance.turn_rad] * 3)
            return ForceTask(
                trajectory=trajectory,
                offset=np.clip(offsets_at(_given(goal), phase), -reach, reach),
                wrench=wrench_at(goal.force, phase),
                task_xyzw=(x, y, z, w),
                admittance=goal.compliance,
                slow_per_n=goal.slow_per_n,
            )

        def publish_feedback(motion: Motion) -> None:
            wrench = to_wrench(runner.port.sample().wrench)
            handle.feedback(CartAdmitFeedback(wrench=wrench, pose=runner.measured_pose(), progress=motion.progress))

        def failed_result(duration_s: float) -> CartAdmitResult:
            pose = runner.measured_pose()
            return CartAdmitResult(
                offsets=None, pose=pose, force_error_rms_n=0.0, force_error_max_n=0.0, duration_s=duration_s
            )

        async with given_path(runner, goal.collisions, tool_contact="along_path") as path:
            task = await path.planned(
                handle, lambda start: runner.planner.make(lambda kinematics: plan(kinematics, start))
            )
            ended = await runner.carry_out(
                lambda: path.monitored(runner.port.track_force(task, tolerance=runner.tolerance)),
                handle,
                publish_feedback,
                failed_result=failed_result,
            )
        record = ForceRecord.from_bytes(ended.report.data) if ended.report.data else None
        passed = record is not None and len(record.shares()) > 0 and not handle.cancel_requested
        errors = _Errors(rms_n=0.0, max_n=0.0) if record is None else force_errors(task, record)
        return CartAdmitResult(
            offsets=learned_offsets(goal, task, record) if record is not None and passed else None,
            pose=runner.measured_pose(),
            force_error_rms_n=errors.rms_n,
            force_error_max_n=errors.max_n,
            duration_s=ended.duration_s,
        )


def learned_offsets(goal: CartAdmitDMP, task: ForceTask, record: ForceRecord) -> CartOffsets:
    """Return the offsets for the next pass: the total offset of this pass over the phase, in the requested kernels."""
    duration_s = task.trajectory.duration_s
    phase = phase_at(record.shares() * duration_s / goal.dmp.tau, goal.dmp.a_x)
    given = _given(goal)
    if goal.N not in (0, len(given.c_o)):
        given = no_offsets(goal.N, a_x=goal.dmp.a_x)
    return offsets_from_samples(phase, record.offsets() - offsets_at(given, phase), given=given)


def force_errors(task: ForceTask, record: ForceRecord) -> _Errors:
    """Return the deviation from the desired force along the active axes, over the record."""
    axes = [axis for axis in range(3) if task.admittance.active[axis] > 0.0]
    if not axes or len(record.shares()) == 0:
        return _Errors(rms_n=0.0, max_n=0.0)
    known = np.linspace(0.0, 1.0, len(task.wrench))
    error = np.zeros((len(record.shares()), len(axes)))
    for column, axis in enumerate(axes):
        error[:, column] = record.wrenches()[:, axis] - np.interp(record.shares(), known, task.wrench[:, axis])
    # Squares of any finite force are finite this way.
    scale = max(1.0, float(np.abs(error).max()))
    sizes = np.linalg.norm(error / scale, axis=1)
    return _Errors(rms_n=scale * float(np.sqrt((sizes**2).mean())), max_n=scale * float(sizes.max()))


def _given(goal: CartAdmitDMP) -> CartOffsets:
    if goal.offsets is not None:
        return goal.offsets
    return no_offsets(goal.N, a_x=goal.dmp.a_x) if goal.N else no_offsets(a_x=goal.dmp.a_x)
