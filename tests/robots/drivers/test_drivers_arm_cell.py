"""A real arm in a cell with a simulated world: motion states, its body where it is measured, a person's permission."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.bus import Holder
from engine.cell.open_cell import OpenCell
from engine.document import load_cell
from engine.errors import FlexcellError, GoalRejected, NoSuchSkill
from engine.messages import FramePoses, JointState, Pose
from engine.messages.device_state import DeviceState
from engine.messages.primitives import CartDmp, JointDmp
from engine.skill import Action
from engine.skills.arm_control import SetController
from engine.skills.devices import EnableDevice
from engine.skills.dmp import CartDMP, JointDMP
from engine.skills.identification import IdentifyPayload
from engine.skills.jogging import JogJoints, JogTool, StepJoints, StepTool
from engine.skills.motion import ForwardKinematics, JointTrapVel
from robots.port import Array
from robots.sim.world.sim_world import SimWorld
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.arm_under_test import CLIENTS, START
from tests.robots.drivers.universal_robots.client_library import needs_client_library
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController
from tests.robots.sim.sim_cell import until

CELL = """\
flexcell: 1
cell: bench
world: {{kind: mujoco, engine_silence_s: 10.0, world_silence_s: 10.0}}
robots:
  left: {{model: ur10}}
  right:
    model: ur10
    base: {{xyz: [0.0, 2.5, 0.0], rpy: [0.0, 0.0, 1.5707963]}}
    driver: {driver}
    outputs: {{gripper: 3}}
    inputs: {{door: 5}}
"""
BEHAVIOR = """\
flexcell: 1
name: tour
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: load
    states:
      load:
        state: motion.SetLoad
        with: {robot: right, mass_kg: 1.5, com_m: [0, 0, 0.05]}
        transitions: {set: frame, failed: failed}
      frame:
        state: motion.SetToolFrame
        with: {robot: right, xyz_m: [0, 0, 0.1]}
        transitions: {set: speed, failed: failed}
      speed: {state: motion.SetSpeed, with: {robot: right, share: 0.9}, transitions: {set: joints, failed: failed}}
      joints:
        state: motion.MoveJoints
        with: {robot: right, target: [0.2, -1.4, 1.6, -1.7, -1.5, 0.1], speed: 0.3}
        transitions: {reached: line, failed: failed}
      line:
        state: motion.MoveLinear
        with: {robot: right, offset_m: [0, 0, 0.05], speed_m_s: 0.1}
        transitions: {reached: waypoints, failed: failed}
      waypoints:
        state: motion.FollowWaypoints
        with:
          robot: right
          speed: 0.3
          waypoints: [{joints: [0.1, -1.4, 1.5, -1.6, -1.5, 0]}, {joints: [0, -1.5, 1.5, -1.5, -1.5, 0]}]
        transitions: {reached: guarded, failed: failed}
      guarded:
        state: motion.MoveUntilContact
        with: {robot: right, direction: [0, 0, -1], distance_m: 0.03, speed_m_s: 0.05, force_n: 20}
        transitions: {contact: failed, no_contact: free, failed: failed}
      free:
        state: motion.MoveFree
        with: {robot: right, joints: [0.3, -1.5, 1.5, -1.5, -1.5, 0]}
        transitions: {reached: plan, blocked: failed, no_way: failed, failed: failed}
      plan:
        state: motion.PlanMotion
        with: {robot: right, joints: [0, -1.5, 1.5, -1.5, -1.5, 0]}
        transitions: {planned: execute, no_way: failed, failed: failed}
      execute:
        state: motion.ExecutePlan
        with: {robot: right}
        transitions: {reached: recover, blocked: failed, failed: failed}
      recover: {state: motion.Recover, with: {robot: right}, transitions: {recovered: output, failed: failed}}
      output:
        state: io.SetOutput
        with: {robot: right, device: gripper, value: true}
        transitions: {set: door, failed: failed}
      door:
        state: io.WaitForInput
        with: {robot: right, name: door, timeout_s: 100.0}
        transitions: {reached: open, timeout: failed, unknown: failed}
      open:
        state: io.ReadInput
        with: {robot: right, input: 4}
        transitions: {"on": failed, "off": other, unknown: failed}
      other:
        state: motion.MoveJoints
        with: {robot: left, target: [0.2, -1.4, 1.6, -1.7, -1.5, 0.1], speed: 0.5}
        transitions: {reached: finished, failed: failed}
"""


def flexcell(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a command; a planning process or a compiler that is not ready in 300 s says so before the limit here."""
    return subprocess.run([FLEXCELL, *arguments], cwd=cwd, capture_output=True, text=True, check=False, timeout=380)


def written(folder: Path, host: str, **options: object) -> Path:
    """Write cell and behavior, and return the cell."""
    patient = {"stale_s": 5.0, "watchdog_hz": 1.0, "process_silence_s": 10.0, "payload_kg": 0.5, **options}
    driver = json.dumps({"kind": "universal_robots", "host": host, **patient})
    (folder / "cell.yaml").write_text(CELL.format(driver=driver), encoding="utf-8")
    (folder / "tour.yaml").write_text(BEHAVIOR, encoding="utf-8")
    return folder / "cell.yaml"


@pytest.mark.parametrize("client", CLIENTS)
def test_a_behavior_moves_a_real_and_a_simulated_arm_once_a_person_permits_it(tmp_path: Path, client: str) -> None:
    """Every motion state once; before that it is refused, and nothing moves."""
    with EmulatedController() as controller:
        written(tmp_path, controller.host, client=client)
        checked = flexcell("check", "tour.yaml", cwd=tmp_path)
        assert (checked.returncode, checked.stdout[-1000:]) == (0, checked.stdout[-1000:])
        refused = flexcell("run", "tour.yaml", cwd=tmp_path)
        assert refused.returncode == 1
        assert "motion is not enabled" in refused.stdout + refused.stderr
        assert controller.state()["q"] == pytest.approx(START.tolist())

        controller.ask("digital_input", bit=5, value=1)
        run = flexcell("run", "tour.yaml", "--enable", "the bench is clear", cwd=tmp_path)
        assert (run.returncode, run.stderr[-2000:]) == (0, run.stderr[-2000:])
        state = controller.wait("at_rest")
        assert state["q"] == pytest.approx([0, -1.5, 1.5, -1.5, -1.5, 0], abs=0.02)
        assert state["payload_kg"] == 2.0
        assert state["tcp_offset"][:3] == pytest.approx([0.0, 0.0, 0.1])
        assert state["digital_outputs"] == 1 << 3
        # The run is over: no program of ours goes on at the controller.
        assert controller.wait("stopped")["runtime_state"] == "STOPPED"


@pytest.mark.parametrize("client", CLIENTS)
def test_a_real_arm_is_read_by_the_command_line_without_being_commanded(tmp_path: Path, client: str) -> None:
    with EmulatedController() as controller:
        written(tmp_path, controller.host, client=client)
        controller.ask("digital_input", bit=5, value=1)
        assert (
            "inputs on: 5 of 0 to 9\n  outputs on: none of 0 to 9"
            in flexcell("devices", "cell.yaml", cwd=tmp_path).stdout
        )
        listed = flexcell("devices", "cell.yaml", "--json", cwd=tmp_path)
        (report,) = json.loads(listed.stdout)
        assert (listed.returncode, report["device"], report["fault"]) == (0, "right", "")
        assert report["state"] == "motion is not enabled"
        assert report["firmware"].startswith("URSoftware 3.15")
        assert report["readings"]["elbow_joint_rad"] == pytest.approx(START[2])
        assert controller.state()["program"] == ""


def test_a_real_arm_has_no_virtual_time(tmp_path: Path) -> None:
    written(tmp_path, "127.0.0.254")
    refused = flexcell("run", "tour.yaml", "--clock", "virtual", cwd=tmp_path)
    assert refused.returncode == 2
    assert "a real arm has no virtual time" in refused.stderr


async def succeeds(cell: OpenCell, goal: Action[Any, Any]) -> None:
    """Send a goal to the real arm and require its success."""
    end = await cell.bus.send_goal(goal, to="right").result()
    assert (end.status.value, end.cause) == ("succeeded", None)


@needs_client_library
async def test_manual_motions_and_primitives_move_a_real_arm(tmp_path: Path) -> None:
    with EmulatedController() as controller:
        async with OpenCell(load_cell(written(tmp_path, controller.host))) as cell:
            await cell.enable("the bench is clear")
            await succeeds(cell, JogJoints(velocity_rad_s=(0.2, 0.0, 0.0, 0.0, 0.0, 0.0), duration_s=0.5))
            await succeeds(cell, JogTool(velocity=(0.0, 0.0, 0.05, 0.0, 0.0, 0.0), duration_s=0.5))
            await succeeds(cell, StepJoints(step_rad=(0.0, 0.0, 0.0, 0.0, 0.0, 0.1), speed=0.5))
            await succeeds(cell, StepTool(step_m=(0.0, 0.0, 0.02), frame="world"))
            await succeeds(cell, JointTrapVel(joints=tuple(START.tolist()), speed=0.5))
            await succeeds(cell, JointDMP(dmp=joint_dmp(START, START + 0.1)))
            await succeeds(cell, JointTrapVel(joints=tuple(START.tolist()), speed=0.5))
            here = await cell.bus.call(ForwardKinematics(), to="right")
            await succeeds(cell, CartDMP(dmp=cart_dmp(here), start_reach_m=0.1, start_reach_rad=0.5))
            with pytest.raises(NoSuchSkill, match="identify it at the teach pendant"):
                cell.bus.send_goal(IdentifyPayload(), to="right")
            with pytest.raises(NoSuchSkill, match="the driver universal_robots has no impedance control"):
                await cell.bus.call(SetController(controller="joint_impedance"), to="right")


@needs_client_library
async def test_the_world_has_the_body_of_a_real_arm_where_it_is_measured(tmp_path: Path) -> None:
    """So do planner, 3D view and cameras, which read the world."""
    with EmulatedController() as controller:
        async with OpenCell(load_cell(written(tmp_path, controller.host))) as cell:
            await cell.enable("the bench is clear")
            goal = tuple((START + 0.3).tolist())
            await succeeds(cell, JointTrapVel(joints=goal, speed=0.5))
            world = cell.world
            assert isinstance(world, SimWorld)
            await until(lambda: bool(np.allclose(world.measured().arm("right").position_rad, goal, atol=0.005)))
            state = cell.bus.topic("right/joint_state", JointState).latest
            assert state is not None
            assert state.position_rad == pytest.approx(goal, abs=0.005)
            tool = await cell.bus.call(ForwardKinematics(), to="right")
            frames = cell.bus.topic("cell/frames", FramePoses).latest
            assert frames is not None
            assert frames.xyz[frames.names.index("right/tool0")] == pytest.approx(tool.xyz, abs=0.005)


@needs_client_library
async def test_after_a_loss_a_person_accepts_the_connection_and_permits_motion_again(tmp_path: Path) -> None:
    with EmulatedController() as controller:
        async with OpenCell(load_cell(written(tmp_path, controller.host))) as cell:
            device = cell.bus.topic("right/device", DeviceState)
            await cell.enable("the bench is clear")
            assert device.latest is not None
            assert device.latest.enabled
            controller.ask("drop")
            await until(lambda: not cell.connection.connected)
            assert "link cut" in cell.connection.reason
            with pytest.raises(FlexcellError, match="link cut"):
                cell.require_connected()
            await until(lambda: device.latest is not None and device.latest.connected)
            with pytest.raises(FlexcellError, match="link cut"):
                await cell.enable("too early")
            await cell.reconnect()
            assert cell.connection.connected
            end = await cell.bus.send_goal(JointTrapVel(joints=tuple(START.tolist()), speed=0.5), to="right").result()
            assert end.cause is not None
            assert "motion was not permitted since" in str(end.cause)
            await cell.enable("looked at it")
            await succeeds(cell, JointTrapVel(joints=tuple((START + 0.1).tolist()), speed=0.5))


@needs_client_library
async def test_a_run_cannot_permit_itself_to_move(tmp_path: Path) -> None:
    with EmulatedController() as controller:
        async with OpenCell(load_cell(written(tmp_path, controller.host))) as cell:
            cell.bus.leases.acquire(("right",), Holder(run="a run"))
            with pytest.raises(GoalRejected, match="is commanded by run a run"):
                await cell.bus.call(EnableDevice(reason="by itself"), to="right")


def joint_dmp(start: Array, goal: Array) -> JointDmp:
    """Return a primitive without a forcing term."""
    return JointDmp(
        N=2, a_z=20.0, a_x=2.0, tau=2.0, goal=tuple(goal.tolist()), y0=tuple(start.tolist()), dy0=(0.0,) * 6,
        c=(1.0, 0.3), sigma=(0.1, 0.1), w=((0.0, 0.0),) * 6,
    )  # fmt: skip


def cart_dmp(here: Pose) -> CartDmp:
    """Return a primitive that lifts the tool by 3 cm."""
    (x, y, z), turn, none = here.xyz, here.xyzw, (0.0, 0.0)
    return CartDmp(
        N=2, a_z=20.0, a_x=2.0, tau=2.0, goal=(x, y, z + 0.03, *turn), y0=(x, y, z, *turn), c=(1.0, 0.3),
        sigma=(0.1, 0.1), w1=none, w2=none, w3=none, w4=none, w5=none, w6=none,
    )  # fmt: skip
