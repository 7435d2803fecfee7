"""The lock of a tool changer: it catches what is at the face, holds with limited force, and nothing jumps."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

from engine.document import Placement, ToolChangerSpec, ToolShape, ToolSpec
from engine.messages import Pose, Vector3
from engine.skills.simulated_world import PushBody
from robots.model.folder.master_plate import MASTER_FACE
from robots.model.transform import RigidTransform, quaternion_of
from robots.scene.sim_scene import PartBody
from robots.sim.commands.world_commands import PushSimBody, ResetFreeParts, RestoreWorld, SwitchToolLock
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell
from tests.robots.sim.sim_cell import LEFT, one_arm

CHANGER = ToolChangerSpec(thickness_m=0.05, time="2 ms", force_n=200.0, torque_nm=20.0)
ARM = replace(LEFT, gripper=None, tool_changer=CHANGER)
TOOL = PartBody(
    name="tool",
    shape="cylinder",
    size_m=(0.063, 0.02),
    mass_kg=0.4,
    pose=Pose(xyz=(0.0, 0.0, 0.0)),
    tool=ToolSpec(
        tcps={"tip": Placement(xyz=(0.0, 0.0, 0.1))},
        shapes=(ToolShape(shape="box", size_m=(0.02, 0.02, 0.08), mass_kg=0.2, at=Placement(xyz=(0.0, 0.0, 0.05))),),
    ),
)
EMPTY = Simulation(build_cell(replace(one_arm(), arms=(ARM,), gravity=False, realism="ideal")))


def world(*, off_m: Vector3 = (0.0, 0.0, 0.0), tilt_rad: float = 0.0, gravity: bool = False) -> Simulation:
    """Return an arm at rest with a tool whose plate is so far from the face of its master plate."""
    offset = RigidTransform.of(
        (off_m[0], off_m[1], off_m[2] + TOOL.face_m), quaternion_of(np.array((tilt_rad, 0.0, 0.0)))
    )
    pose = frame(EMPTY, f"left/{MASTER_FACE}").then(offset).to_pose("world")
    scene = replace(one_arm(replace(TOOL, pose=pose)), arms=(ARM,), gravity=gravity, realism="ideal")
    return Simulation(build_cell(scene))


def snapshot(sim: Simulation) -> SimSnapshot:
    values = sim.layout.new_array()
    sim.write_snapshot(values)
    return SimSnapshot(sim.layout, values)


def frame(sim: Simulation, name: str) -> RigidTransform:
    return RigidTransform.of(*snapshot(sim).frame(name))


def run(sim: Simulation, seconds: float) -> None:
    for _ in range(round(seconds / sim.step_s)):
        sim.step()


def shut(sim: Simulation, *, on: bool = True) -> None:
    sim.apply(SwitchToolLock(arm="left", on=on))
    run(sim, 0.03)


def off_the_face(sim: Simulation) -> RigidTransform:
    """Return the pose of the face of the tool in that of the master plate; the identity when they meet."""
    face = frame(sim, f"left/{MASTER_FACE}").inverse().then(frame(sim, "tool"))
    return face.then(RigidTransform.of((0.0, 0.0, -TOOL.face_m), (0.0, 0.0, 0.0, 1.0)))


def contacts(sim: Simulation) -> float:
    return sim.measures.layout.read(sim.measures.values())["cell.contacts"]


def push(sim: Simulation, force_n: float, seconds: float = 0.1) -> None:
    """Pull the tool along the axis of the face."""
    axis = frame(sim, f"left/{MASTER_FACE}").rotation[:, 2]
    x, y, z = (force_n * axis).tolist()
    sim.apply(PushSimBody(push=PushBody(body="tool", force_n=(x, y, z), duration_s=seconds)))
    run(sim, seconds)


def test_a_tool_at_the_face_is_caught_and_drawn_to_it_without_a_jump() -> None:
    sim = world(off_m=(0.0004, -0.0003, 0.0004), tilt_rad=0.005)
    assert snapshot(sim).tool_lock("left") == (False, False, True)
    sim.apply(SwitchToolLock(arm="left", on=True))
    places = [frame(sim, "tool").xyz]
    for _ in range(100):
        sim.step()
        places.append(frame(sim, "tool").xyz)
    assert np.linalg.norm(np.diff(places, axis=0), axis=1).max() < 2e-4
    assert snapshot(sim).tool_lock("left") == (True, True, True)
    assert snapshot(sim).held_part("left") == "tool"
    assert np.linalg.norm(off_the_face(sim).xyz) < 1e-4


@pytest.mark.parametrize(
    ("off_m", "tilt_rad"),
    [((0.0, 0.0, 0.0013), 0.0), ((0.0013, 0.0, 0.0001), 0.0), ((0.0, 0.0, 0.0003), 0.025)],
    ids=["gap", "aside", "tilted"],
)
def test_a_tool_beyond_the_tolerance_is_not_caught(off_m: Vector3, tilt_rad: float) -> None:
    """It moves freely afterwards, also once it meets the face: the piston has passed."""
    sim = world(off_m=off_m, tilt_rad=tilt_rad)
    shut(sim)
    assert snapshot(sim).tool_lock("left")[:2] == (True, False)
    push(sim, -2.0, 0.2)
    assert snapshot(sim).held_part("left") == ""


def test_the_lock_alone_holds_the_weight_and_lets_it_fall_when_it_opens() -> None:
    sim = world(gravity=True)
    shut(sim)
    run(sim, 0.5)
    assert np.linalg.norm(off_the_face(sim).xyz) < 2e-4
    shut(sim, on=False)
    run(sim, 0.2)
    assert snapshot(sim).tool_lock("left") == (False, False, False)
    assert off_the_face(sim).xyz[2] > 0.1


@pytest.mark.parametrize(("force_n", "holds"), [(150.0, True), (260.0, False)])
def test_more_force_than_the_lock_holds_tears_the_tool_off(force_n: float, *, holds: bool) -> None:
    """The output stays on, and the sensor tells that the tool is gone; it is not caught again."""
    sim = world()
    shut(sim)
    push(sim, force_n)
    assert snapshot(sim).tool_lock("left")[:2] == (True, holds)
    assert (snapshot(sim).held_part("left") == "tool") == holds
    assert (off_the_face(sim).xyz[2] < 0.001) == holds


def test_a_lock_that_opens_holds_and_tells_so_until_its_piston_has_arrived() -> None:
    sim = world()
    shut(sim)
    sim.apply(SwitchToolLock(arm="left", on=False))
    sim.step()
    assert snapshot(sim).tool_lock("left") == (False, True, True)
    sim.step()
    assert snapshot(sim).tool_lock("left") == (False, False, True)


def test_a_restored_world_still_holds_the_tool() -> None:
    sim = world(gravity=True)
    shut(sim)
    image = np.zeros(sim.image_layout.size)
    sim.write_image(image)
    other = world(gravity=True)
    other.apply(RestoreWorld(image=image))
    run(other, 0.3)
    assert snapshot(other).tool_lock("left") == (True, True, True)
    assert np.linalg.norm(off_the_face(other).xyz) < 2e-4
    shut(other, on=False)
    run(other, 0.1)
    assert snapshot(other).held_part("left") == ""


def test_a_reset_of_the_parts_opens_the_lock() -> None:
    sim = world(gravity=True)
    shut(sim)
    sim.apply(ResetFreeParts())
    assert snapshot(sim).tool_lock("left")[:2] == (False, False)
    run(sim, 0.2)
    assert off_the_face(sim).xyz[2] > 0.1


def test_what_the_lock_takes_is_no_contact_and_what_it_does_not_take_is_one() -> None:
    taken, missed = world(off_m=(0.0, 0.0, -0.0002)), world(off_m=(0.0, 0.0, -0.0002))
    shut(taken)
    run(missed, 0.03)
    assert (contacts(taken), contacts(missed)) == (0.0, 1.0)
