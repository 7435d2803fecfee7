"""The device interfaces of the skill servers, simulated or real: measure, move, hold, resume, cancel.

Whether a measured tool holds something is decided here too, so that servers and topics say the same.

Arrays are float64, joints in the model's order, radians. All members are called from the event
loop thread; an implementation may run its control elsewhere but completes futures on that loop.
"""

from robots.port.arm import ArmPort, ArmSample, DelayedSettings, StreamKind
from robots.port.arrays import Array
from robots.port.force_task import ForceRecord, ForceTask
from robots.port.grasp_check import GraspCommand
from robots.port.gripper import GripperPort, GripperSample
from robots.port.hand import HandPort, HandSample
from robots.port.inputs import InputPort
from robots.port.motion import Motion, MotionEnd, MotionReport, MotionStream
from robots.port.outputs import ConfirmedOutputs, NamedOutputs, OutputOwner, OutputPort, SwitchableOutputs
from robots.port.separation import MeasuredSeparation, PermittedSpeed, SeparationRule
from robots.port.trajectory import ContactCondition, JointTrajectory, Tolerance

__all__ = [
    "ArmPort",
    "ArmSample",
    "Array",
    "ConfirmedOutputs",
    "ContactCondition",
    "DelayedSettings",
    "ForceRecord",
    "ForceTask",
    "GraspCommand",
    "GripperPort",
    "GripperSample",
    "HandPort",
    "HandSample",
    "InputPort",
    "JointTrajectory",
    "MeasuredSeparation",
    "Motion",
    "MotionEnd",
    "MotionReport",
    "MotionStream",
    "NamedOutputs",
    "OutputOwner",
    "OutputPort",
    "PermittedSpeed",
    "SeparationRule",
    "StreamKind",
    "SwitchableOutputs",
    "Tolerance",
]
