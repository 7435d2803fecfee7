"""How hard arms touch first, by speed and stiffness of what is touched: `first_touch.py [--realism typical]`.

A guarded motion of 100 mm meets a surface in its middle, at its peak speed, and ends at 5 N; once at one speed, once
with a peak of 10 N, of which the first 45 mm are clear. Then force control presses with 15 N from 10 mm above, and
after a guarded touch, while the tool moves 40 mm along the surface, which rises by 0.05. Arms in MuJoCo, virtual time.
Run it with `python -P`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.force_controlled_wiping import FRICTION, PANDA, UP, UR10, Subject
from engine.document import RealismName
from engine.messages import Pose
from engine.skills.contact import RIGID_N_M
from engine.skills.dmp import Compliance
from robots.control.commanding.arm_commands import FollowTrajectory, TrackForce
from robots.control.motion_event import MotionFinished
from robots.model.mechanics.dynamics import ArmDynamics
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform, quaternion_of
from robots.motion import plan_line
from robots.motion.min_jerk import PEAK_SPEED
from robots.motion.speed_profile import MIN_JERK, plan_approach
from robots.motion.touch_speed import effective_mass_kg, friction_push_n, touch_speed_m_s
from robots.port import Array, ContactCondition, ForceTask, JointTrajectory, MotionEnd, MotionReport, Tolerance
from robots.scene.sim_scene import ArmPlacement, FixtureBody, SimScene
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell

STEP_S = 0.001
CONTACT_N, PEAK_N, DESIRED_N = 5.0, 10.0, 15.0
GAP_M, CLEAR_M, PRESS_GAP_M, ALONG_M, SLOPE = 0.05, 0.045, 0.01, 0.04, 0.05
# How far beyond the tool centre point the pads of each arm touch the inclined surface.
PADS_M = {"panda": 0.0121, "ur10": -0.0055}
SPEEDS_M_S = (0.005, 0.01, 0.02, 0.05)
# None is a rigid fixture.
STIFFNESSES_N_M: tuple[float | None, ...] = (1000.0, 5000.0, 50000.0, None)
SUBJECTS = (PANDA, UR10)


@dataclass(frozen=True, kw_only=True)
class Touch:
    """The force of one motion along the vertical, N, once in every period, and its report."""

    report: MotionReport
    forces_n: tuple[float, ...]

    @property
    def peak_n(self) -> float:
        """The greatest force."""
        return max(self.forces_n)

    @property
    def duration_s(self) -> float:
        """Time until rest."""
        return len(self.forces_n) * STEP_S


class TouchRig:
    """One arm above a surface that rises by `SLOPE` along its path."""

    def __init__(
        self,
        subject: Subject,
        *,
        stiffness_n_m: float | None,
        gap_m: float = GAP_M,
        realism: RealismName = "ideal",
    ) -> None:
        self._along = np.array(subject.along)
        base = Pose(xyz=(0.0, 0.0, 0.0))
        placement = ArmPlacement(name="arm", model=subject.model, base=base, gripper=subject.gripper)
        self._model = placement.robot()
        self.kinematics = ArmKinematics(self._model, base=RigidTransform.from_pose(base))
        joints = np.array(subject.start_rad)
        below_m = gap_m + PADS_M[subject.model]
        surface = self._surface(self.kinematics.tool_pose(joints), below_m, stiffness_n_m)
        scene = SimScene(step_s=STEP_S, arms=(placement,), fixtures=(surface,), realism=realism, seed=1)
        self.simulation = Simulation(build_cell(scene))
        self.control = self.simulation.control("arm")
        self._number = 0
        self._move_to(joints)

    def _move_to(self, joints: Array) -> None:
        start = self.control.motion.position.copy()
        u = np.linspace(0.0, 1.0, 501)[:, None]
        trajectory = JointTrajectory(
            dt_s=0.004,
            position_rad=start + (joints - start) * (10 * u**3 - 15 * u**4 + 6 * u**5),
            velocity_rad_s=(joints - start) * (30 * u**2 - 60 * u**3 + 30 * u**4) / 2.0,
        )
        self._number += 1
        self.simulation.apply(
            FollowTrajectory(arm="arm", motion=self._number, trajectory=trajectory, tolerance=Tolerance())
        )
        moved = self._finished()
        assert moved.report.end is MotionEnd.REACHED, moved.report

    def _surface(self, tool: RigidTransform, below_m: float, stiffness_n_m: float | None) -> FixtureBody:
        thick = 0.01
        turn = quaternion_of(np.arctan(SLOPE) * np.cross(self._along, UP))
        top = tool.xyz + np.array((0.0, 0.0, -below_m))
        middle = RigidTransform(xyz=top, xyzw=turn).then(
            RigidTransform(xyz=np.array((0.0, 0.0, -thick / 2.0)), xyzw=quaternion_of(np.zeros(3)))
        )
        return FixtureBody(
            name="surface",
            shape="box",
            size_m=(0.6, 0.6, thick),
            pose=middle.to_pose("world"),
            spring_n_m=stiffness_n_m or 0.0,
            skin_friction=FRICTION,
        )

    def touch(self, speed_m_s: float, *, peak_n: float | None = None) -> Touch:
        """Go down until contact, with `peak_n` as slowly as it requires after `CLEAR_M`."""
        joints = self.control.motion.position.copy()
        here = self.kinematics.tool_pose(joints)
        distance_m = 2.0 * GAP_M
        profile, duration_s = MIN_JERK, PEAK_SPEED * distance_m / speed_m_s
        if peak_n is not None:
            mass_kg = effective_mass_kg(ArmDynamics(self._model), self.kinematics, joints, -np.array(UP))
            friction_n = friction_push_n(self.kinematics, joints, -np.array(UP))
            allowed_m_s = touch_speed_m_s(mass_kg, peak_n=peak_n, surface_n_m=RIGID_N_M, friction_n=friction_n)
            touch_m_s = min(speed_m_s, allowed_m_s)
            profile, duration_s = plan_approach(distance_m, clear_m=CLEAR_M, speed_m_s=speed_m_s, touch_m_s=touch_m_s)
        end = RigidTransform(xyz=here.xyz - distance_m * np.array(UP), xyzw=here.xyzw)
        trajectory = plan_line(self.kinematics, joints, end, duration_s=duration_s, profile=profile)
        self._number += 1
        until = ContactCondition(force_n=CONTACT_N, direction=UP)
        self.simulation.apply(
            FollowTrajectory(arm="arm", motion=self._number, trajectory=trajectory, tolerance=Tolerance(), until=until)
        )
        return self._finished()

    def press(self, *, touch_m_s: float = Compliance().touch_m_s, speed_m_s: float = 0.05) -> Touch:
        """Press with `DESIRED_N` while the tool moves along; `touch_m_s` of 0.05 is that of the damping alone."""
        joints = self.control.motion.position.copy()
        here = self.kinematics.tool_pose(joints)
        end = RigidTransform(xyz=here.xyz + ALONG_M * self._along, xyzw=here.xyzw)
        trajectory = plan_line(self.kinematics, joints, end, duration_s=PEAK_SPEED * ALONG_M / speed_m_s)
        wrench = np.zeros((len(trajectory.position_rad), 6))
        wrench[:, 2] = DESIRED_N
        law = Compliance(touch_m_s=touch_m_s)
        task = ForceTask(trajectory=trajectory, offset=np.zeros_like(wrench), wrench=wrench, admittance=law)
        self._number += 1
        self.simulation.apply(TrackForce(arm="arm", motion=self._number, task=task, tolerance=Tolerance()))
        return self._finished()

    def _finished(self) -> Touch:
        forces: list[float] = []
        while True:
            for event in self.simulation.step():
                if isinstance(event, MotionFinished):
                    return Touch(report=event.report, forces_n=tuple(forces))
            forces.append(float(self.control.state.wrench[2]))
            assert len(forces) < 100_000


def _surface_name(stiffness_n_m: float | None) -> str:
    return "rigid" if stiffness_n_m is None else f"{stiffness_n_m:g}"


def _print_touches(realism: RealismName) -> None:
    print("| arm | surface N/m | speed mm/s | peak N | until rest s | with a peak of 10 N: peak N | until rest s |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for subject in SUBJECTS:
        for stiffness in STIFFNESSES_N_M:
            for speed_m_s in SPEEDS_M_S:
                cells: list[str] = []
                for peak_n in (None, PEAK_N):
                    rig = TouchRig(subject, stiffness_n_m=stiffness, realism=realism)
                    touch = rig.touch(speed_m_s, peak_n=peak_n)
                    missed = "" if touch.report.contact else " (no contact)"
                    cells += [f"{touch.peak_n:.1f}{missed}", f"{touch.duration_s:.1f}"]
                head = (subject.model, _surface_name(stiffness), f"{speed_m_s * 1e3:.0f}")
                print("| " + " | ".join((*head, *cells)) + " |", flush=True)


def _print_pressing(realism: RealismName) -> None:
    print("\n| arm | surface N/m | pressing | peak N at 50 mm/s | at 10 mm/s |\n|---|---:|---|---:|---:|")
    for subject in SUBJECTS:
        for stiffness in STIFFNESSES_N_M:
            for first in ("from above", "after a touch"):
                cells: list[str] = []
                for touch_m_s in (0.05, 0.01):
                    rig = TouchRig(subject, stiffness_n_m=stiffness, gap_m=PRESS_GAP_M, realism=realism)
                    if first == "after a touch":
                        rig.touch(0.01)
                    cells.append(f"{rig.press(touch_m_s=touch_m_s).peak_n:.1f}")
                print("| " + " | ".join((subject.model, _surface_name(stiffness), first, *cells)) + " |", flush=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--realism", choices=("ideal", "typical", "poor"), default="ideal")
    options = parser.parse_args(arguments)
    _print_touches(options.realism)
    _print_pressing(options.realism)


if __name__ == "__main__":
    main()
