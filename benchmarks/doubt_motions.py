"""Figures of motions whose arms differ from their models, see `benchmarks.doubt`: one text for each realism."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks.first_touch import PANDA, PEAK_N, PRESS_GAP_M, UR10, Subject, TouchRig
from benchmarks.force_controlled_wiping import Wiping, rms, three_passes
from engine.document import RealismName
from engine.messages import Pose
from engine.skills.arm_control import ControllerName, ControlSettings
from robots.control.commanding.arm_commands import ConfigureArm, FollowTrajectory
from robots.control.motion_event import MotionFinished
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion import plan_line
from robots.motion.min_jerk import min_jerk
from robots.port import Array, JointTrajectory, Tolerance
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell

IRB4600 = Subject(model="irb4600", gripper="magnet", start_rad=(0.0, 0.2, 0.2, 0.0, 0.8, 0.0))
_STEP_S = 0.001
_FAST_S, _FAST_RAD = 0.8, 0.3
_LINE_S, _LINE_M = 1.5, 0.15
_REST_S = 1.0
_ENDS = 10
# A path error that does not end the motion: it is what is measured.
_TOLERANCE = Tolerance(path_rad=1.0, goal_rad=1.0)


class _FreeArm:
    """One arm with nothing around it."""

    def __init__(self, subject: Subject, law: ControllerName, realism: RealismName) -> None:
        base = Pose(xyz=(0.0, 0.0, 0.0))
        placement = ArmPlacement(name="arm", model=subject.model, base=base, gripper=subject.gripper)
        self.kinematics = ArmKinematics(placement.robot(), base=RigidTransform.from_pose(base))
        scene = SimScene(step_s=_STEP_S, arms=(placement,), realism=realism, seed=1)
        self.simulation = Simulation(build_cell(scene))
        self.simulation.apply(ConfigureArm(arm="arm", settings=ControlSettings(controller=law)))
        self.control = self.simulation.control("arm")
        self._motion = 0
        self.joint_error_rad = self.tool_error_m = self.torque_nm = self.waited_s = 0.0
        self.joints_to(np.array(subject.start_rad), 2.0)

    def joints_to(self, goal: Array, duration_s: float) -> None:
        """Move the joints with minimum jerk, and measure."""
        start = self.control.motion.position.copy()
        u = np.linspace(0.0, 1.0, 401)
        knots = start + min_jerk(u)[:, None] * (goal - start)
        slopes = np.gradient(knots, duration_s / 400.0, axis=0)
        slopes[[0, -1]] = 0.0
        self._follow(JointTrajectory(dt_s=duration_s / 400.0, position_rad=knots, velocity_rad_s=slopes))

    def line(self, by_m: Array, duration_s: float) -> None:
        """Move the tool straight, and measure."""
        joints = self.control.motion.position.copy()
        here = self.kinematics.tool_pose(joints)
        end = RigidTransform(xyz=here.xyz + by_m, xyzw=here.xyzw)
        self._follow(plan_line(self.kinematics, joints, end, duration_s=duration_s))

    def rest(self) -> None:
        """Stand still, and measure."""
        self._clear()
        for _ in range(round(_REST_S / _STEP_S)):
            self.simulation.step()
            self._measure()

    def _clear(self) -> None:
        self.joint_error_rad = self.tool_error_m = self.torque_nm = 0.0

    def _follow(self, trajectory: JointTrajectory) -> None:
        self._clear()
        self.waited_s = -trajectory.duration_s
        self._motion += 1
        self.simulation.apply(
            FollowTrajectory(arm="arm", motion=self._motion, trajectory=trajectory, tolerance=_TOLERANCE)
        )
        while not any(isinstance(event, MotionFinished) for event in self.simulation.step()):
            self._measure()
            self.waited_s += _STEP_S

    def behind_m(self) -> float:
        """Return how far the tool is from its set point now."""
        desired = self.kinematics.tool_pose(self.control.motion.position)
        return desired.distance_m(self.kinematics.tool_pose(self.control.state.position))

    def _measure(self) -> None:
        control = self.control
        error_rad = np.abs(control.motion.position - control.state.position)
        self.joint_error_rad = max(self.joint_error_rad, float(error_rad.max()))
        self.tool_error_m = max(self.tool_error_m, self.behind_m())
        self.torque_nm = max(self.torque_nm, float(np.abs(control.state.external_nm).max()))


def _tracking(subject: Subject, law: ControllerName, realism: RealismName) -> str:
    arm = _FreeArm(subject, law, realism)
    arm.rest()
    still_rad = arm.joint_error_rad
    arm.joints_to(np.array(subject.start_rad) + _FAST_RAD, _FAST_S)
    return f"{still_rad * 1e3:.2f} / {arm.joint_error_rad * 1e3:.1f}; {arm.torque_nm:.1f}"


def _line(subject: Subject, law: ControllerName, realism: RealismName) -> str:
    arm = _FreeArm(subject, law, realism)
    arm.line(_LINE_M * np.array((0.0, 1.0, 0.0)), _LINE_S)
    moving_m = arm.tool_error_m
    arm.rest()
    return f"{moving_m * 1e3:.2f} / {arm.tool_error_m * 1e3:.2f}"


def ends(subject: Subject, law: ControllerName, realism: RealismName) -> tuple[list[float], list[float]]:
    """Return by how much the tool was behind where motions were reported as reached, m, and for how long each waited.

    Ten motions of the joints to random goals of up to 0.3 rad, quick and slow ones, as friction holds the slow ones.
    """
    arm, random = _FreeArm(subject, law, realism), np.random.default_rng(3)
    behind_m: list[float] = []
    waited_s: list[float] = []
    for k in range(_ENDS):
        offset = (0.3, 0.3, 0.05, 0.05, 0.01)[k % 5] * random.uniform(-1.0, 1.0, len(subject.start_rad))
        arm.joints_to(np.array(subject.start_rad) + offset, _FAST_S if k % 2 else 2.0)
        behind_m.append(arm.behind_m())
        waited_s.append(max(0.0, arm.waited_s))
        arm.rest()
    return behind_m, waited_s


def _reached(subject: Subject, law: ControllerName, realism: RealismName) -> str:
    behind_m, waited_s = ends(subject, law, realism)
    behind, waited = np.array(behind_m) * 1e3, np.array(waited_s) * 1e3
    return f"{np.mean(behind):.2f} / {max(behind):.2f}; {np.mean(waited):.0f} / {max(waited):.0f}"


def _guarded(subject: Subject, realism: RealismName) -> str:
    touch = TouchRig(subject, stiffness_n_m=None, realism=realism).touch(0.05, peak_n=PEAK_N)
    return f"{touch.peak_n:.1f}" if touch.report.contact else f"{touch.peak_n:.1f}, no contact"


def _pressing(subject: Subject, stiffness_n_m: float | None, realism: RealismName) -> str:
    pressed = TouchRig(subject, stiffness_n_m=stiffness_n_m, gap_m=PRESS_GAP_M, realism=realism).press()
    return f"{pressed.peak_n:.1f} / {pressed.forces_n[-1]:.1f}"


def _wiping(subject: Subject, law: ControllerName, realism: RealismName) -> str:
    wiping = Wiping(subject, slope=0.05, settings=ControlSettings(controller=law), realism=realism)
    errors = [made.steady(after_s=1.0, step_s=_STEP_S) for made in three_passes(wiping, peak_m_s=0.1)]
    return "; ".join(f"{rms(error):.2f} / {np.abs(error).max():.2f}" for error in (errors[0], errors[-1]))


LAWS: tuple[ControllerName, ...] = ("joint_impedance", "cartesian_impedance")
FIGURES: dict[str, Callable[[RealismName], str]] = {
    **{
        f"{arm.model}, {law.removesuffix('_impedance')}: joint error at rest / in 0.8 s, mrad; external torque, N m":
            partial(_tracking, arm, law)
        for arm in (PANDA, UR10, IRB4600)
        for law in LAWS
    },
    **{
        f"{arm.model}, {law.removesuffix('_impedance')}: tool error along 0.15 m in 1.5 s / at rest, mm":
            partial(_line, arm, law)
        for arm in (PANDA, UR10)
        for law in LAWS
    },
    **{
        f"{arm.model}, {law.removesuffix('_impedance')}: tool behind at `reached`, mean / worst mm; waited for it, ms":
            partial(_reached, arm, law)
        for arm in (PANDA, UR10, IRB4600)
        for law in LAWS
    },
    **{f"{arm.model}: peak of 10 N wanted on a rigid surface, N": partial(_guarded, arm) for arm in (PANDA, UR10)},
    **{
        f"{arm.model}: pressing with 15 N from above on {name}, peak / end N": partial(_pressing, arm, stiffness)
        for arm in (PANDA, UR10)
        for name, stiffness in (("5000 N/m", 5000.0), ("a rigid surface", None))
    },
    **{
        f"{arm.model}, {law.removesuffix('_impedance')}: 10 N up a slope, rms / worst error in pass 1; in pass 3, N":
            partial(_wiping, arm, law)
        for arm in (PANDA, UR10)
        for law in LAWS
    },
}  # fmt: skip
"""What is measured, by what it is; all laws and arms whose figures differ."""


def measure_figure(name: str, realism: RealismName) -> str:
    """Return a figure, or why its motion failed."""
    try:
        return FIGURES[name](realism)
    except AssertionError as failure:
        reason = re.search(r"reason=('[^']*'|\"[^\"]*\")", str(failure))
        return f"fails: {reason[1][1:-1] if reason else 'no contact'}"
