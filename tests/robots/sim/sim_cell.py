"""Small simulated cells for tests, opened on the running loop."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager

import msgspec
import numpy as np
import pytest

from engine.clock import VirtualLoop
from engine.messages import Pose, Vector3
from robots.model.registry import model_by_name
from robots.model.robot_model import JointLimits
from robots.motion.min_jerk import PEAK_ACCELERATION, PEAK_SPEED
from robots.port import ArmPort, Array, JointTrajectory, MotionEnd, MotionReport, Tolerance
from robots.scene.sim_scene import ArmPlacement, FixtureBody, PartBody, SimScene
from robots.sim.world.sim_world import SimWorld, new_world
from tests.tiers import nightly

_LOCKSTEP = pytest.param("lockstep", marks=pytest.mark.virtual)
both_hosts = pytest.mark.parametrize("host", [_LOCKSTEP, "process"])
"""The same world stepped by a virtual clock, and by a process of its own in real time."""
both_hosts_nightly = pytest.mark.parametrize("host", [_LOCKSTEP, nightly("process")])
"""What `both_hosts` has shown to be the same already; in real time it takes its time."""

# Of a minimum-jerk motion, as a share of distance over duration cubed.
_PEAK_JERK = 60.0

PANDA = model_by_name("panda")
HOME = np.array(PANDA.home_rad)
TABLE = FixtureBody(name="table", shape="box", size_m=(1.6, 1.2, 0.04), pose=Pose(xyz=(0.0, 0.0, -0.02)))
LEFT = ArmPlacement(name="left", model="panda", base=Pose(xyz=(-0.55, 0.0, 0.0)))
RIGHT = ArmPlacement(name="right", model="panda", base=Pose(xyz=(0.55, 0.0, 0.0), xyzw=(0.0, 0.0, 1.0, 0.0)))

# Configurations of the left arm, hand pointing down, fingers along y, tool centre point in the world at:
PART_XYZ = (-0.09, 0.28, 0.02)
ABOVE_PART = np.array([0.079516, 0.271183, 0.462131, -2.258997, -0.199114, 2.493332, 1.471841])  # z 0.15
AT_PART = np.array([0.178605, 0.581023, 0.319763, -2.207157, -0.444087, 2.728343, 1.644956])  # z 0.022
LIFTED = np.array([-0.048806, 0.176277, 0.600081, -2.239824, -0.144093, 2.380583, 1.434102])  # z 0.2


def box(name: str, xyz: Vector3 = PART_XYZ, *, mass_kg: float = 0.12) -> PartBody:
    """Return a part of 60 x 30 x 40 mm."""
    return PartBody(name=name, shape="box", size_m=(0.06, 0.03, 0.04), mass_kg=mass_kg, pose=Pose(xyz=xyz))


# Longer than a loaded machine keeps a process waiting; what is to be noticed says so with `watched`.
PATIENT_S = 20.0


def one_arm(*parts: PartBody) -> SimScene:
    """Return the left arm at a table with these parts."""
    return _patient(LEFT, parts=parts)


def two_arms(*parts: PartBody) -> SimScene:
    """Return both arms at a table with these parts."""
    return _patient(LEFT, RIGHT, parts=parts)


def watched(scene: SimScene, *, silence_s: float = 1.0) -> SimScene:
    """Return a scene in which engine and world act on each other's silence that soon."""
    return msgspec.structs.replace(scene, engine_silence_s=silence_s, world_silence_s=silence_s)


def _patient(*arms: ArmPlacement, parts: tuple[PartBody, ...]) -> SimScene:
    return SimScene(arms=arms, fixtures=(TABLE,), parts=parts, engine_silence_s=PATIENT_S, world_silence_s=PATIENT_S)


def smooth(start: Array, goal: Array, duration_s: float, *, limits: JointLimits = PANDA.limits) -> JointTrajectory:
    """Return a minimum-jerk motion between two configurations, sampled every 2 ms.

    It takes longer where the limits of the arm need more time.
    """
    duration_s = max(duration_s, _least_s(np.abs(goal - start), limits))
    u = np.linspace(0.0, 1.0, round(duration_s / 0.002) + 1)[:, None]
    return JointTrajectory(
        dt_s=0.002,
        position_rad=start + (goal - start) * (10 * u**3 - 15 * u**4 + 6 * u**5),
        velocity_rad_s=(goal - start) * (30 * u**2 - 60 * u**3 + 30 * u**4) / duration_s,
    )


def _least_s(span_rad: Array, limits: JointLimits) -> float:
    speed = PEAK_SPEED * span_rad / np.array(limits.velocity_rad_s)
    push = PEAK_ACCELERATION * span_rad / np.array(limits.acceleration_rad_s2)
    jerk = _PEAK_JERK * span_rad / np.array(limits.jerk_rad_s3)
    return float(np.maximum(np.maximum(speed, np.sqrt(push)), np.cbrt(jerk)).max())


async def move(
    arm: ArmPort, goal: Array, duration_s: float = 1.0, *, limits: JointLimits = PANDA.limits
) -> MotionReport:
    """Go from the set point to `goal` and return the report."""
    path = smooth(np.asarray(arm.sample().desired_rad), goal, duration_s, limits=limits)
    motion = arm.follow(path, tolerance=Tolerance())
    return await motion.report()


async def grasp(world: SimWorld, *, force_n: float = 20.0) -> None:
    """Reach for the part and close the fingers."""
    arm = world.arm("left")
    assert (await move(arm, ABOVE_PART, 1.2)).end is MotionEnd.REACHED
    assert (await move(arm, AT_PART, 0.8)).end is MotionEnd.REACHED
    report = await world.gripper("left").close_to(width_m=0.0, speed_m_s=0.05, force_n=force_n).report()
    assert report.end is MotionEnd.REACHED


def unhurried(host: str, duration_s: float) -> float:
    """Return how long a motion takes that is looked at on its way.

    In real time it does not wait for who looks, so there it lasts long enough for one who comes late.
    """
    return duration_s if host == "lockstep" else 4.0 * duration_s


async def until(condition: Callable[[], bool], *, within_s: float = 30.0) -> None:
    """Return once `condition` holds, in the time of the loop; raises TimeoutError when it never does."""
    async with asyncio.timeout(within_s):
        # What is measured tells nobody that it has changed: it can only be looked at.
        while not condition():  # noqa: ASYNC110
            await asyncio.sleep(0.002)


@asynccontextmanager
async def opened(scene: SimScene) -> AsyncGenerator[SimWorld]:
    """Open a world in lockstep on a virtual loop, in its own process on a real one."""
    virtual = isinstance(asyncio.get_running_loop(), VirtualLoop)
    async with new_world(scene, virtual=virtual) as world:
        yield world
        await world.stop()


def part_xyz(world: SimWorld, name: str) -> Vector3:
    """Return where a part is now."""
    xyz, _ = world.measured().frames()
    return xyz[world.host.summary.frames.index(name)]
