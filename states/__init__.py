"""What a behavior can do: the standard states by name. A state sees the engine only.

`CATALOGUE` is what the entry point `flexcell.states` offers; a new state is added to the list here.
"""

from collections.abc import Mapping

from engine.state import State
from states.cell.expect_part import ExpectPart
from states.flow.decide import Decide
from states.flow.log import Log
from states.flow.set_value import SetValue
from states.flow.wait import Wait
from states.gripper.check_held import CheckHeld
from states.gripper.grasp import Grasp
from states.gripper.move import Move
from states.gripper.open import Open
from states.motion.move_joints import MoveJoints
from states.motion.move_linear import MoveLinear
from states.motion.move_pose import MovePose
from states.store.read_entry import ReadEntry
from states.store.write_entry import WriteEntry

_STATES: tuple[type[State], ...] = (
    CheckHeld,
    Decide,
    ExpectPart,
    Grasp,
    Log,
    Move,
    MoveJoints,
    MoveLinear,
    MovePose,
    Open,
    ReadEntry,
    SetValue,
    Wait,
    WriteEntry,
)

CATALOGUE: Mapping[str, type[State]] = {state.state_name: state for state in _STATES}
"""State name → class."""

__all__ = ["CATALOGUE"]
