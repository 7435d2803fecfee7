"""How steadily arms press while they wipe an inclined surface that gives way, and how passes improve.

`python -P benchmarks/force_controlled_wiping.py` prints a table: a Panda and a UR10 in MuJoCo, 10 N, up to 0.1 m/s,
both pads of their grippers flat on the surface or, where it is inclined, on an edge of one. `--first-touch 0.9` gives
the surface MuJoCo's default contact; why that chatters is in `benchmarks/contact_sliding.py`.
"""

from __future__ import annotations

import argparse
import math
import time
from dataclasses import dataclass

import numpy as np

from engine.document import RealismName
from engine.messages import Pose
from engine.skills.arm_control import ControlSettings
from engine.skills.dmp import Compliance
from robots.control.commanding.arm_commands import ConfigureArm, FollowTrajectory, TrackForce
from robots.control.motion_event import MotionFinished
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform, quaternion_of
from robots.motion.cart_line import plan_line
from robots.motion.min_jerk import PEAK_SPEED
from robots.port import (
    Array,
    ContactCondition,
    ForceRecord,
    ForceTask,
    JointTrajectory,
    MotionEnd,
    MotionReport,
    Tolerance,
)
from robots.scene.sim_scene import ArmPlacement, FixtureBody, SimScene
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell

FORCE_N = 10.0
CLEARANCE_M = 0.006
APPROACH_M_S = 0.02
UP = (0.0, 0.0, 1.0)
SPRING_N_M, SPRING_NS_M, FRICTION = 5000.0, 60.0, 0.3
# The sampling of what a pass has learned is smoothed over this many rows of its record.
WINDOW = 13


@dataclass(frozen=True, kw_only=True)
class Subject:
    """An arm, how it stands when it begins to wipe, and along what it wipes."""

    model: str
    gripper: str | None
    start_rad: tuple[float, ...]
    along: tuple[float, float, float] = (0.0, 1.0, 0.0)


PANDA = Subject(model="panda", gripper="panda_hand", start_rad=(0.0, 0.35, 0.0, -2.1, 0.0, 2.45, 0.785))
UR10 = Subject(model="ur10", gripper="robotiq_2f85", start_rad=(0.0, -1.3, 2.0, -2.2707963, -1.5707963, 0.0))


@dataclass(frozen=True, kw_only=True)
class Pass:
    """Forces along the surface's normal over one pass, and what it has learned."""

    forces_n: Array
    """At every control period of the pass."""
    record: ForceRecord
    report: MotionReport

    def steady(self, *, after_s: float, step_s: float) -> Array:
        """Return the errors of the force after the first `after_s`."""
        return self.forces_n[round(after_s / step_s) :] - FORCE_N


class Wiping:
    """One arm above a surface that is inclined by `slope` along the path and gives way along its normal.

    `first_touch` replaces the share of a contact's force that is rigid at first touch (MuJoCo's solimp[0]).
    """

    def __init__(
        self,
        subject: Subject,
        *,
        slope: float,
        length_m: float = 0.2,
        step_s: float = 0.001,
        settings: ControlSettings | None = None,
        first_touch: float | None = None,
        realism: RealismName = "typical",
    ) -> None:
        placement = ArmPlacement(
            name="arm", model=subject.model, base=Pose(xyz=(0.0, 0.0, 0.0)), gripper=subject.gripper
        )
        self._along = np.array(subject.along)
        self._length_m = length_m
        model = placement.robot()
        self._kinematics = ArmKinematics(model, base=RigidTransform.from_pose(placement.base))
        start = self._kinematics.tool_pose(np.array(subject.start_rad))
        surface = self._surface(start, slope)
        scene = SimScene(step_s=step_s, arms=(placement,), fixtures=(surface,), realism=realism)
        cell = build_cell(scene)
        if first_touch is not None:
            cell.model.geom("surface").solimp[0] = first_touch
        self.simulation = Simulation(cell)
        if settings is not None:
            self.simulation.apply(ConfigureArm(arm="arm", settings=settings))
        self.control = self.simulation.control("arm")
        self._number = 0
        self._begin = np.array(subject.start_rad)
        self._move_to(self._begin)

    def _surface(self, start: RigidTransform, slope: float) -> FixtureBody:
        """Return a plate whose surface rises by `slope` along the path, `CLEARANCE_M` below the tool."""
        thick = 0.01
        turn = RigidTransform(xyz=np.zeros(3), xyzw=quaternion_of(math.atan(slope) * np.cross(self._along, UP)))
        middle = (
            start.xyz
            + self._length_m / 2.0 * self._along
            - np.array([0.0, 0.0, CLEARANCE_M - slope * self._length_m / 2.0])
        )
        xyz = middle - turn.rotation @ np.array([0.0, 0.0, thick / 2.0])
        pose = RigidTransform(xyz=xyz, xyzw=turn.xyzw).to_pose("world")
        return FixtureBody(
            name="surface",
            shape="box",
            size_m=(0.6, 0.6, thick),
            pose=pose,
            spring_n_m=SPRING_N_M,
            spring_ns_m=SPRING_NS_M,
            skin_friction=FRICTION,
        )

    def approach(self) -> MotionReport:
        """Go down until contact."""
        joints = self.control.motion.position.copy()
        here = self._kinematics.tool_pose(joints)
        deep = 3.0 * CLEARANCE_M
        below = RigidTransform(xyz=here.xyz - np.array([0.0, 0.0, deep]), xyzw=here.xyzw)
        trajectory = plan_line(self._kinematics, joints, below, duration_s=PEAK_SPEED * deep / APPROACH_M_S)
        self._number += 1
        until = ContactCondition(force_n=3.0, direction=UP)
        self.simulation.apply(
            FollowTrajectory(arm="arm", motion=self._number, trajectory=trajectory, tolerance=Tolerance(), until=until)
        )
        return self._finished()[0]

    def wipe(self, *, learned: ForceRecord | None, peak_m_s: float, slow_per_n: float = 0.0) -> Pass:
        """Press along the path, after a guarded approach, and go back above its beginning.

        `learned` is what the pass before recorded; without it nothing is known of the surface.
        """
        approach = self.approach()
        assert approach.contact, approach
        joints = self.control.motion.position.copy()
        here = self._kinematics.tool_pose(joints)
        end = RigidTransform(xyz=here.xyz + self._length_m * self._along, xyzw=here.xyzw)
        trajectory = plan_line(self._kinematics, joints, end, duration_s=PEAK_SPEED * self._length_m / peak_m_s)
        task = pressing(trajectory, learned=learned, slow_per_n=slow_per_n)
        self._number += 1
        self.simulation.apply(TrackForce(arm="arm", motion=self._number, task=task, tolerance=Tolerance()))
        report, forces = self._finished()
        self._move_to(self._begin)
        return Pass(forces_n=forces, record=ForceRecord.from_bytes(report.data), report=report)

    def _move_to(self, joints: Array) -> None:
        start = self.control.motion.position.copy()
        u = np.linspace(0.0, 1.0, 501)[:, None]
        trajectory = JointTrajectory(
            dt_s=0.002,
            position_rad=start + (joints - start) * (10 * u**3 - 15 * u**4 + 6 * u**5),
            velocity_rad_s=(joints - start) * (30 * u**2 - 60 * u**3 + 30 * u**4),
        )
        self._number += 1
        self.simulation.apply(
            FollowTrajectory(arm="arm", motion=self._number, trajectory=trajectory, tolerance=Tolerance())
        )
        report, _ = self._finished()
        assert report.end is MotionEnd.REACHED, report

    def _finished(self) -> tuple[MotionReport, Array]:
        forces: list[float] = []
        while True:
            for event in self.simulation.step():
                if isinstance(event, MotionFinished):
                    return event.report, np.array(forces)
            forces.append(float(self.control.state.wrench[2]))
            assert len(forces) < 100_000


def pressing(trajectory: JointTrajectory, *, learned: ForceRecord | None, slow_per_n: float) -> ForceTask:
    """Return the task to press down with 10 N on this path."""
    samples = len(trajectory.position_rad)
    wrench = np.zeros((samples, 6))
    wrench[:, 2] = FORCE_N
    offset = np.zeros((samples, 6)) if learned is None else smoothed(learned, samples=samples)
    return ForceTask(
        trajectory=trajectory, offset=offset, wrench=wrench, admittance=Compliance(), slow_per_n=slow_per_n
    )


def smoothed(record: ForceRecord, *, samples: int) -> Array:
    """Return the offsets of a pass at equal shares of the trajectory's time, (samples, 6), without their noise."""
    window = np.hanning(WINDOW) / np.hanning(WINDOW).sum()
    share = np.linspace(0.0, 1.0, samples)
    columns = [np.convolve(np.pad(c, WINDOW // 2, mode="edge"), window, "valid") for c in record.offsets().T]
    return np.stack([np.interp(share, record.shares(), column) for column in columns], axis=1)


def three_passes(wiping: Wiping, *, peak_m_s: float) -> list[Pass]:
    """Wipe three times, each time with what the pass before has learned."""
    passes: list[Pass] = []
    for _ in range(3):
        passes.append(wiping.wipe(learned=passes[-1].record if passes else None, peak_m_s=peak_m_s))
    return passes


def rms(values: Array) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(values * values)))


def row(cells: tuple[str, ...]) -> None:
    """Print one line of the table."""
    print("  ".join(f"{cell:>12}" for cell in cells))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--speed", type=float, default=0.1, help="fastest speed along the surface, m/s (default 0.1)")
    parser.add_argument("--first-touch", type=float, help="rigid share of a contact at first touch, of the surface")
    options = parser.parse_args()
    surface = f"a surface of {SPRING_N_M:g} N/m, friction {FRICTION:g}"
    print(f"{FORCE_N:g} N on {surface}, up to {options.speed:g} m/s; errors in N after 1 s")
    row(("arm", "controller", "slope", "pass", "mean", "rms", "worst", "x real time"))
    for subject in (PANDA, UR10):
        for controller in ("joint_impedance", "cartesian_impedance"):
            for slope in (0.0, 0.05):
                settings = ControlSettings(controller=controller)
                wiping = Wiping(subject, slope=slope, settings=settings, first_touch=options.first_touch)
                start, from_s = time.thread_time(), wiping.simulation.time_s
                passes = three_passes(wiping, peak_m_s=options.speed)
                speed = (wiping.simulation.time_s - from_s) / (time.thread_time() - start)
                for number, made in enumerate(passes, 1):
                    error = made.steady(after_s=1.0, step_s=wiping.simulation.step_s)
                    numbers = (f"{error.mean():+.3f}", f"{rms(error):.3f}", f"{np.abs(error).max():.3f}")
                    row(
                        (
                            subject.model,
                            controller.removesuffix("_impedance"),
                            f"{slope:g}",
                            str(number),
                            *numbers,
                            f"{speed:.1f}",
                        )
                    )


if __name__ == "__main__":
    main()
