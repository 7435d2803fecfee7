"""Bonds in physics: what they carry decides whether they hold, and a part that has come off moves by itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robots.sim.commands.world_commands import DriveAxis, ResetFreeParts, RestoreWorld
from robots.sim.loop.bond_reading import BondReading
from tests.robots.sim.bond_rig import BondRig

# The weight of the box is 9.81 N; its centre is 0.05 m beside the place of the bond.
BEAM = """\
flexcell: 1
cell: bench
world: {{kind: mujoco}}
fixtures:
  beam: {{shape: box, size_m: [0.1, 0.1, 0.02], at: {{xyz: [0, 0, 1]}}}}
parts:
  box: {{shape: box, size_m: [0.1, 0.1, 0.02], mass_kg: 1, at: {{xyz: [0.101, 0, 1]}}}}
bonds:
  seam: {{kind: glue, part: box, to: beam, at_m: [-0.05, 0, 0], {limits}}}
"""
WEIGHT_N, MOMENT_NM = 9.81, 0.4905

# A lid on a box, held by two clips on each of its long sides, and a lever below its front edge.
LID = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  housing: {shape: box, size_m: [0.1, 0.08, 0.04], at: {xyz: [0, 0, 0.02]}}
  lever: {shape: box, size_m: [0.02, 0.04, 0.01], at: {xyz: [-0.065, 0, 0.03]}}
parts:
  lid: {shape: box, size_m: [0.14, 0.08, 0.01], mass_kg: 0.05, at: {xyz: [0, 0, 0.0451]}}
bonds:
  front_left: {kind: clip, part: lid, to: housing, at_m: [-0.045, 0.035, 0], force_n: 15, point: true}
  front_right: {kind: clip, part: lid, to: housing, at_m: [-0.045, -0.035, 0], force_n: 15, point: true}
  back_left: {kind: clip, part: lid, to: housing, at_m: [0.045, 0.035, 0], force_n: 15, point: true}
  back_right: {kind: clip, part: lid, to: housing, at_m: [0.045, -0.035, 0], force_n: 15, point: true}
devices:
  press:
    axes:
      up: {body: lever, joint: slide, along: [0, 0, 1], stroke_m: 0.05, force_n: FORCE, speed_m_s: 0.05, output: lift}
    positions:
      up: {steps: [{set: {lift: true}}], time: 1}
"""


def beam(folder: Path, limits: str, *, seed: int | None = None) -> BondRig:
    """Return the box at the beam."""
    return BondRig(folder, BEAM.format(limits=limits), seed=seed)


def test_the_load_of_a_bond_is_the_weight_that_hangs_on_it_and_its_moment(tmp_path: Path) -> None:
    rig = beam(tmp_path, "force_n: 100")
    rig.pass_time(1.0)
    assert rig.bonds()["seam"].force_n == pytest.approx(WEIGHT_N, rel=0.01)
    assert rig.bonds()["seam"].torque_nm == pytest.approx(MOMENT_NM, rel=0.01)
    assert rig.place("box").tolist() == pytest.approx([0.101, 0.0, 1.0], abs=2e-4)


@pytest.mark.parametrize(
    ("limits", "broken_by"),
    [
        (f"force_n: {WEIGHT_N / 0.8}", ""),
        (f"force_n: {WEIGHT_N / 1.2}", "force"),
        (f"torque_nm: {MOMENT_NM / 0.8}", ""),
        (f"torque_nm: {MOMENT_NM / 1.2}", "torque"),
        ("jitter: 0", ""),
    ],
)
def test_it_holds_at_four_fifths_of_its_limit_and_breaks_at_six_fifths(
    tmp_path: Path, limits: str, broken_by: str
) -> None:
    """The last has no limit and holds for good."""
    rig = beam(tmp_path, limits)
    rig.pass_time(0.5)
    assert rig.bonds()["seam"].broken_by == broken_by
    assert rig.place("box")[2] == pytest.approx(1.0, abs=1e-3) if not broken_by else rig.place("box")[2] < 0.5


def test_a_blow_of_two_milliseconds_does_not_break_it_and_a_pull_does(tmp_path: Path) -> None:
    rig = beam(tmp_path, "force_n: 20")
    rig.pass_time(0.2)
    rig.push("box", 60.0, 0.0, 0.0, duration_s=0.002)
    rig.pass_time(0.2)
    assert rig.bonds()["seam"].broken_by == ""
    rig.push("box", 60.0, 0.0, 0.0)
    rig.pass_time(0.1)
    assert rig.bonds()["seam"] == BondReading(broken_by="force", force_n=0.0, torque_nm=0.0)


def test_what_is_broken_stays_so_in_an_image_and_is_whole_after_a_reset(tmp_path: Path) -> None:
    rig = beam(tmp_path, "force_n: 20")
    rig.pass_time(0.1)
    whole = rig.image()
    rig.push("box", 60.0, 0.0, 0.0, duration_s=0.05)
    rig.pass_time(0.1)
    broken = rig.image()
    rig.apply(RestoreWorld(image=whole))
    rig.pass_time(0.3)
    assert (rig.bonds()["seam"].broken_by, rig.place("box")[2]) == ("", pytest.approx(1.0, abs=1e-3))
    rig.apply(RestoreWorld(image=broken))
    rig.pass_time(0.5)
    assert (rig.bonds()["seam"].broken_by, bool(rig.place("box")[2] < 0.5)) == ("force", True)
    rig.apply(ResetFreeParts())
    rig.pass_time(0.3)
    assert (rig.bonds()["seam"].broken_by, rig.place("box")[2]) == ("", pytest.approx(1.0, abs=1e-3))


def test_limits_deviate_with_the_seed(tmp_path: Path) -> None:
    def limits(seed: int | None) -> tuple[float | None, float | None]:
        bond = beam(tmp_path, "force_n: 10, cut_n: 20, jitter: 0.2", seed=seed).scene.bonds["seam"]
        return bond.force_n, bond.cut_n

    drawn = [limits(seed) for seed in range(20)]
    assert limits(None) == (10.0, 20.0)
    assert limits(3) == drawn[3]
    forces = [force_n for force_n, _ in drawn if force_n is not None]
    assert len(set(forces)) == 20
    assert 8.0 <= min(forces) < 9.0 < 11.0 < max(forces) <= 12.0


def test_joined_parts_are_displaced_as_one(tmp_path: Path) -> None:
    text = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
parts:
  board: {shape: box, size_m: [0.1, 0.1, 0.02], mass_kg: 1, jitter: {xy_m: 0.05, yaw_rad: 1}}
  cell: {shape: box, size_m: [0.1, 0.1, 0.02], mass_kg: 1, at: {xyz: [0.101, 0, 0]}}
bonds:
  seam: {kind: solder, part: cell, to: board}
"""
    rig = BondRig(tmp_path, text, seed=5)
    board, cell = (body.pose for body in rig.scene.parts)
    assert np.linalg.norm(np.subtract(cell.xyz, board.xyz)) == pytest.approx(0.101)
    assert cell.xyzw == pytest.approx(board.xyzw)
    assert abs(cell.xyz[1]) > 0.01
    rig.pass_time(0.01)
    assert rig.bonds()["seam"].force_n < 0.1


@pytest.mark.parametrize(("force_n", "opens"), [(25, False), (60, True)])
def test_a_lever_on_an_axis_opens_the_front_clips_of_a_lid_if_it_presses_enough(
    tmp_path: Path, force_n: float, opens: bool
) -> None:
    """Both together hold 30 N, a little nearer to the back clips than the lever is; on these the lid turns."""
    rig = BondRig(tmp_path, LID.replace("FORCE", str(force_n)))
    rig.pass_time(0.1)
    rig.apply(DriveAxis(fixture="lever", direction=1.0))
    rig.pass_time(1.5)
    broken = {name for name, bond in rig.bonds().items() if bond.broken_by}
    assert broken == ({"front_left", "front_right"} if opens else set[str]())
    assert bool(rig.place("lid")[2] > 0.055) is opens


def test_the_clips_of_a_lid_share_a_pull_and_come_off_together(tmp_path: Path) -> None:
    """Four of them hold 60 N; the lid weighs 0.5 N."""
    rig = BondRig(tmp_path, LID.replace("FORCE", "25"))
    rig.push("lid", 0.0, 0.0, 50.0)
    rig.pass_time(0.5)
    assert {bond.broken_by for bond in rig.bonds().values()} == {""}
    rig.push("lid", 0.0, 0.0, 70.0, duration_s=0.1)
    rig.pass_time(0.1)
    assert {bond.broken_by for bond in rig.bonds().values()} == {"force"}
