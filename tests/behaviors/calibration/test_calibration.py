"""The shipped behaviors that calibrate: an operator brings the tip of a simulated arm to points, and answers."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import Cell
from engine.event import Event, UserdataWritten
from engine.messages import FramePoses, Pose, Quaternion, RobotDescription, Vector3
from engine.messages.pose_algebra import angle_between_rad, compose_poses, compose_rotations, rotate_vector
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.skills.arm_control import ControlSettings, ReadArm, SetEndEffectorFrame
from engine.skills.goal_end import GoalStatus
from engine.skills.motion import CartLinTask, CartTrapVel
from engine.store import SqliteStore
from tests.behaviors.application import Application, causes, changed_cell, without_parts
from tests.tiers import nightly

ASKING = RunOptions(autonomy="low", demand_operator=True)
TIP: Vector3 = (0.012, -0.02, 0.06)
"""The tip of the tool in the tool link, which the arm does not know."""
POINT: Vector3 = (-0.1, 0.05, 0.3)
DOWN: Quaternion = (1.0, 0.0, 0.0, 0.0)
TILT_RAD = 0.5
COMPUTE = "root/compute"
SEEDS = pytest.mark.parametrize("seed", [3, nightly(1), nightly(2)])
_LOOK_S = 0.02
_CORRECTIONS = 8
_SETTLE_S = 0.3


def turned(axis: Vector3, angle_rad: float) -> Quaternion:
    """The tool pointing down, turned about an axis of its own."""
    x, y, z = (value * math.sin(angle_rad / 2) for value in axis)
    return compose_rotations(DOWN, (x, y, z, math.cos(angle_rad / 2)))


FOUR = (
    turned((0.0, 0.0, 1.0), 0.0),
    turned((1.0, 0.0, 0.0), TILT_RAD),
    turned((0.0, 1.0, 0.0), TILT_RAD),
    turned((0.0, 0.0, 1.0), 0.8),
)


@dataclass(kw_only=True)
class Operator:
    """Brings the true tip to a point at each question, with small corrections, answers, and agrees to the result.

    Args:
        touches: Path that asks → the point and the orientation of the tool.
        within_m: Distance of the true tip from the point at which the operator is content.
        calibrated: The tool centre point that the arm has from the start, in its tool link.
    """

    touches: dict[str, tuple[Vector3, Quaternion]]
    within_m: float
    calibrated: Vector3 = (0.0, 0.0, 0.0)
    settings: ControlSettings | None = None

    async def __call__(self, run: Run, cell: OpenCell) -> None:
        await cell.bus.call(SetEndEffectorFrame(xyz_m=self.calibrated), to="left")
        for path, (point, xyzw) in self.touches.items():
            await self._asked(run, cell, path)
            await self._touch(cell, point, xyzw)
            run.control.answer(path)
        await self._asked(run, cell, COMPUTE)
        run.control.answer(COMPUTE)
        while True:
            self.settings = (await cell.bus.call(ReadArm(), to="left")).settings
            await cell.bus.clock.sleep(_LOOK_S)

    async def _asked(self, run: Run, cell: OpenCell, path: str) -> None:
        while not any(waiting.path == path for waiting in run.control.view().waiting):
            await cell.bus.clock.sleep(_LOOK_S)

    async def _touch(self, cell: OpenCell, point: Vector3, xyzw: Quaternion) -> None:
        x, y, z = (p - r for p, r in zip(point, rotate_vector(xyzw, difference(TIP, self.calibrated)), strict=True))
        target = Pose(xyz=(x, y, z), xyzw=xyzw)
        end = await cell.bus.send_goal(CartTrapVel(pose=target, speed=0.5), to="left").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        for _ in range(_CORRECTIONS):
            await cell.bus.clock.sleep(_SETTLE_S)
            off = difference(point, true_tip(cell))
            if math.hypot(*off) <= self.within_m:
                return
            x, y, z = (a + b for a, b in zip(target.xyz, off, strict=True))
            target = Pose(xyz=(x, y, z), xyzw=xyzw)
            await cell.bus.send_goal(CartLinTask(pose=target, duration_s=0.3), to="left").result()
        raise AssertionError(f"the tip is still {math.dist(point, true_tip(cell)) * 1e3:.3f} mm from the point")


def difference(one: Vector3, other: Vector3) -> Vector3:
    """The first less the second."""
    x, y, z = (a - b for a, b in zip(one, other, strict=True))
    return (x, y, z)


def true_tip(cell: OpenCell) -> Vector3:
    """Where the tip of the tool is in the simulated world."""
    frames = cell.bus.topic("cell/frames", FramePoses).latest
    description = cell.bus.topic("left/description", RobotDescription).latest
    assert frames is not None
    assert description is not None
    row = frames.names.index(description.tool_frame)
    return compose_poses(Pose(xyz=frames.xyz[row], xyzw=frames.xyzw[row]), Pose(xyz=TIP)).xyz


def arm(realism: str, folder: Path) -> Cell:
    """The cell of two Pandas with the left one only, of that realism, and without parts."""

    def changed(text: str) -> str:
        left_only = re.sub(r"(?ms)^  right:.*?^$", "", without_parts(text))
        return left_only.replace("step_s: 0.001}", f"step_s: 0.001, realism: {realism}}}")

    return changed_cell("dual_panda", folder, cell=changed)


def written(log: list[Event], key: str) -> Any:
    """What a state has written under a key."""
    (value,) = (event.value for event in log if isinstance(event, UserdataWritten) and event.key == key)
    return msgspec.to_builtins(value)


def entry(folder: Path, kind: str, name: str) -> dict[str, object]:
    """What the run has stored."""

    async def value() -> dict[str, object]:
        async with SqliteStore.open(folder / "store.db", inline=True) as store:
            return (await store.get(kind, name)).value

    return run_virtual(value())


@SEEDS
@pytest.mark.parametrize(("realism", "within_m", "off_m"), [("ideal", 1e-6, 2e-6), ("typical", 1e-4, 5e-4)])
def test_four_touches_give_the_true_tool_centre_point(
    tmp_path: Path, seed: int, realism: str, within_m: float, off_m: float
) -> None:
    """It is set and stored when the operator has agreed to its residual."""
    operator = Operator(
        touches={f"root/touch_{number}": (POINT, xyzw) for number, xyzw in enumerate(FOUR, 1)}, within_m=within_m
    )
    done = Application(
        behavior="calibration/tool_centre_point.yaml",
        cell=arm(realism, tmp_path),
        seed=seed,
        meanwhile=operator,
        supervision=ASKING,
    )
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    tip_m, residual_m = written(done.log, "tool_xyz_m"), written(done.log, "residual_m")
    assert math.dist(tip_m, TIP) < off_m
    assert residual_m < off_m
    assert operator.settings is not None
    assert operator.settings.tool_xyz_m == tuple(tip_m)
    assert entry(tmp_path, "record", "left_tool_centre_point") == {
        "xyz_m": list(tip_m),
        "residual_m": residual_m,
    }


@SEEDS
@pytest.mark.parametrize(
    ("realism", "within_m", "off_m", "off_rad"), [("ideal", 1e-6, 2e-6, 2e-5), ("typical", 1e-4, 1e-3, 3e-3)]
)
def test_three_touches_give_the_true_frame(
    tmp_path: Path, seed: int, realism: str, within_m: float, off_m: float, off_rad: float
) -> None:
    """Up to the errors of the arm's base, which the touches cannot show."""
    truth = Pose(xyz=(-0.15, -0.05, 0.25), xyzw=(0.0, math.sin(0.1), 0.0, math.cos(0.1)))
    at = {"origin": (0.0, 0.0, 0.0), "x": (0.15, 0.0, 0.0), "plane": (0.05, 0.15, 0.0)}
    operator = Operator(
        touches={f"root/touch_{name}": (compose_poses(truth, Pose(xyz=xyz)).xyz, DOWN) for name, xyz in at.items()},
        within_m=within_m,
        calibrated=TIP,
    )
    done = Application(
        behavior="calibration/three_point_frame.yaml",
        cell=arm(realism, tmp_path),
        seed=seed,
        meanwhile=operator,
        supervision=ASKING,
    )
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    stored = msgspec.convert(entry(tmp_path, "pose", "left_base"), Pose)
    assert math.dist(stored.xyz, truth.xyz) < off_m
    assert angle_between_rad(stored.xyzw, truth.xyzw) < off_rad


def test_without_an_operator_nothing_moves_and_the_tilt_is_the_reason(tmp_path: Path) -> None:
    done = Application(behavior="calibration/tool_centre_point.yaml", cell=arm("typical", tmp_path), seed=3)
    result = done.run(tmp_path)
    assert result.outcome == "failed"
    assert "the orientations are too alike" in causes(result)
    assert "tilted by 0.0 deg at most between two poses, at least 20.1 deg needed" in causes(result)
    assert "root/set set" not in done.left
