"""Every standard state keeps the contract of states."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from engine.document.signature import read_signature
from engine.registry import load_states
from engine.state import State
from states import CATALOGUE

STANDARD = load_states()
"""Those of the package and those that come with kinds of tools."""
ROOT = Path(__file__).parents[2]


def test_the_catalogue_has_the_standard_states() -> None:
    """Behaviors name states by these words; a missing one breaks them."""
    assert sorted(STANDARD) == [
        "bus.CallService",
        "bus.CheckMessage",
        "bus.Publish",
        "bus.SendGoal",
        "bus.WaitForMessage",
        "calibration.FourPointTool",
        "calibration.ThreePointFrame",
        "cell.ExpectPart",
        "cell.PlugModule",
        "cell.Reach",
        "cell.UnplugModule",
        "cell.Withdraw",
        "equipment.CheckBase",
        "equipment.CheckDevice",
        "equipment.CheckHexapod",
        "equipment.CheckTool",
        "equipment.MoveDevice",
        "equipment.MoveHexapod",
        "equipment.PullBase",
        "equipment.PutTool",
        "equipment.SelectToolPoint",
        "equipment.TakeTool",
        "flow.Decide",
        "flow.Log",
        "flow.SetValue",
        "flow.Wait",
        "gripper.CheckHeld",
        "gripper.Grasp",
        "gripper.Move",
        "gripper.Open",
        "hand.CheckHeld",
        "hand.Close",
        "hand.Open",
        "io.ReadInput",
        "io.SetDutyCycle",
        "io.SetOutput",
        "io.WaitForInput",
        "magnet.CheckHeld",
        "magnet.Off",
        "magnet.On",
        "manipulation.PickPart",
        "manipulation.PlacePart",
        "motion.ExecutePlan",
        "motion.FollowCartDmp",
        "motion.FollowJointDmp",
        "motion.FollowRecording",
        "motion.FollowWaypoints",
        "motion.Guide",
        "motion.IdentifyFriction",
        "motion.IdentifyPayload",
        "motion.LearnCartDmp",
        "motion.LearnJointDmp",
        "motion.MoveFree",
        "motion.MoveJoints",
        "motion.MoveLinear",
        "motion.MovePose",
        "motion.MoveUntilContact",
        "motion.PlanMotion",
        "motion.PressAlongDmp",
        "motion.ReadPose",
        "motion.Recover",
        "motion.SetCollision",
        "motion.SetController",
        "motion.SetImpedance",
        "motion.SetLoad",
        "motion.SetSpeed",
        "motion.SetToolFrame",
        "scene.AllowContact",
        "scene.Attach",
        "scene.Check",
        "scene.Detach",
        "scene.ForgetOccupancy",
        "scene.PutObstacle",
        "scene.RemoveObstacle",
        "store.ReadEntry",
        "store.WriteEntry",
        "vision.Detect",
    ]


@pytest.mark.parametrize("state", STANDARD.values(), ids=STANDARD)
def test_a_standard_state_declares_itself_completely(state: type[State]) -> None:
    """Its signature reads, its success is among its outcomes, it and its parameters are described."""
    signature = read_signature(state)
    assert signature.doc
    assert signature.name == state.state_name
    assert state.__name__ == state.state_name.partition(".")[2]
    assert set(signature.success) <= set(signature.outcomes)
    assert signature.success
    undescribed = [name for name, key in signature.parameters.items() if "description" not in str(key.schema)]
    assert undescribed == []


def test_every_state_file_is_in_the_catalogue() -> None:
    """A state that nobody can name is dead."""
    files = {path.stem for path in (ROOT / "states").glob("*/*.py") if "State, frozen=True" in path.read_text()}
    modules = {state.__module__.rpartition(".")[2] for state in CATALOGUE.values()}
    assert modules == files


def test_importing_the_states_brings_no_robot_and_no_browser() -> None:
    """The library is found without side effects: no simulator, no server, no robots."""
    script = (
        "import sys, states; "
        "print([m for m in sys.modules if m.split('.')[0] in ('robots', 'editor_web', 'mujoco', 'numpy', 'fastapi')])"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
