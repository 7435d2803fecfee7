"""The standard states by name. A state depends on the engine only.

The entry point `flexcell.states` exports `CATALOGUE`; add a new state to the list here.
"""

from collections.abc import Mapping

from engine.state import State
from states.bus.call_service import CallService
from states.bus.check_message import CheckMessage
from states.bus.publish import Publish
from states.bus.send_goal import SendGoal
from states.bus.wait_for_message import WaitForMessage
from states.calibration.four_point_tool import FourPointTool
from states.calibration.three_point_frame import ThreePointFrame
from states.cell.expect_part import ExpectPart
from states.cell.plug_module import PlugModule
from states.cell.reach import Reach
from states.cell.unplug_module import UnplugModule
from states.cell.withdraw import Withdraw
from states.equipment.check_base import CheckBase
from states.equipment.check_device import CheckDevice
from states.equipment.check_hexapod import CheckHexapod
from states.equipment.check_tool import CheckTool
from states.equipment.move_device import MoveDevice
from states.equipment.move_hexapod import MoveHexapod
from states.equipment.pull_base import PullBase
from states.equipment.put_tool import PutTool
from states.equipment.select_tool_point import SelectToolPoint
from states.equipment.take_tool import TakeTool
from states.flow.decide import Decide
from states.flow.log import Log
from states.flow.set_value import SetValue
from states.flow.wait import Wait
from states.gripper.check_held import CheckHeld
from states.gripper.grasp import Grasp
from states.gripper.move import Move
from states.gripper.open import Open
from states.hand.check_held import CheckHeld as HandCheckHeld
from states.hand.close import Close as HandClose
from states.hand.open import Open as HandOpen
from states.io.read_input import ReadInput
from states.io.set_duty_cycle import SetDutyCycle
from states.io.set_output import SetOutput
from states.io.wait_for_input import WaitForInput
from states.manipulation.pick_part import PickPart
from states.manipulation.place_part import PlacePart
from states.motion.execute_plan import ExecutePlan
from states.motion.follow_cart_dmp import FollowCartDmp
from states.motion.follow_joint_dmp import FollowJointDmp
from states.motion.follow_recording import FollowRecording
from states.motion.follow_waypoints import FollowWaypoints
from states.motion.guide import Guide
from states.motion.identify_friction import IdentifyFriction
from states.motion.identify_payload import IdentifyPayload
from states.motion.learn_dmp import LearnCartDmp, LearnJointDmp
from states.motion.move_free import MoveFree
from states.motion.move_joints import MoveJoints
from states.motion.move_linear import MoveLinear
from states.motion.move_pose import MovePose
from states.motion.move_until_contact import MoveUntilContact
from states.motion.plan_motion import PlanMotion
from states.motion.press_along_dmp import PressAlongDmp
from states.motion.read_pose import ReadPose
from states.motion.recover import Recover
from states.motion.set_collision import SetCollision
from states.motion.set_controller import SetController
from states.motion.set_impedance import SetImpedance
from states.motion.set_load import SetLoad
from states.motion.set_speed import SetSpeed
from states.motion.set_tool_frame import SetToolFrame
from states.scene.allow_contact import AllowContact
from states.scene.attach import Attach
from states.scene.check import Check
from states.scene.detach import Detach
from states.scene.forget_occupancy import ForgetOccupancy
from states.scene.put_obstacle import PutObstacle
from states.scene.remove_obstacle import RemoveObstacle
from states.store.read_entry import ReadEntry
from states.store.write_entry import WriteEntry
from states.vision.detect import Detect

_STATES: tuple[type[State], ...] = (
    AllowContact,
    Attach,
    CallService,
    Check,
    CheckBase,
    CheckDevice,
    CheckHexapod,
    CheckHeld,
    CheckMessage,
    CheckTool,
    Decide,
    Detach,
    Detect,
    ExecutePlan,
    ExpectPart,
    FollowCartDmp,
    FollowJointDmp,
    FollowRecording,
    FollowWaypoints,
    ForgetOccupancy,
    FourPointTool,
    Grasp,
    Guide,
    HandCheckHeld,
    HandClose,
    HandOpen,
    IdentifyFriction,
    IdentifyPayload,
    LearnCartDmp,
    LearnJointDmp,
    Log,
    Move,
    MoveDevice,
    MoveHexapod,
    MoveFree,
    MoveJoints,
    MoveLinear,
    MovePose,
    MoveUntilContact,
    Open,
    PickPart,
    PlacePart,
    PlanMotion,
    PlugModule,
    PressAlongDmp,
    Publish,
    PullBase,
    PutObstacle,
    PutTool,
    Reach,
    ReadEntry,
    ReadPose,
    Recover,
    RemoveObstacle,
    SelectToolPoint,
    SendGoal,
    SetCollision,
    SetController,
    SetImpedance,
    SetLoad,
    SetDutyCycle,
    SetOutput,
    ReadInput,
    WaitForInput,
    SetSpeed,
    SetToolFrame,
    SetValue,
    TakeTool,
    ThreePointFrame,
    UnplugModule,
    Wait,
    WaitForMessage,
    Withdraw,
    WriteEntry,
)

CATALOGUE: Mapping[str, type[State]] = {state.state_name: state for state in _STATES}
"""State name → class."""

__all__ = ["CATALOGUE"]
