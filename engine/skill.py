"""A skill is a frozen, typed request that declares its result type.

`class Move(Action[Reached, Progress])` declares the goal, the result and the feedback of an
action; `class Read(Service[Entry])` declares a request and its response. The bus
address of a skill is `<namespace>/<skill_name>`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, ClassVar, Generic, Literal, TypeVar, get_args, get_origin

import msgspec

R = TypeVar("R")
F = TypeVar("F")

ARM_SKILL_TITLES = {
    "joint_trap_vel": "move to joints",
    "cart_trap_vel": "move to a pose",
    "cart_lin_task": "line to a pose",
    "forward_kinematics": "forward kinematics",
    "inverse_kinematics": "inverse kinematics",
    "all_inverse_kinematics": "all inverse kinematics",
    "plan_motion": "plan a motion",
    "execute_plan": "execute a plan",
    "move_free": "collision-free motion",
    "move_until_contact": "move until contact",
    "joint_dmp": "joint primitive",
    "cart_dmp": "Cartesian primitive",
    "cart_admit_dmp": "force-controlled primitive",
    "learn_joint_dmp": "learn a joint primitive",
    "learn_cart_dmp": "learn a Cartesian primitive",
    "prepare_jog": "prepare jogging",
    "jog_joints": "jog joints",
    "jog_tool": "jog the tool",
    "step_joints": "step joints",
    "step_tool": "step the tool",
    "guide_arm": "hand guiding",
    "finish_guiding": "end hand guiding",
    "switch_direct_control": "direct control",
    "trace_motion": "trace a motion",
    "read_arm": "read the state",
    "set_speed_override": "set the speed override",
    "set_controller": "set the controller",
    "set_joint_impedance": "set the joint impedance",
    "set_cartesian_impedance": "set the Cartesian impedance",
    "set_end_effector_frame": "set the end effector frame",
    "set_load": "set the load",
    "set_collision_behavior": "set the collision behavior",
    "recover_from_error": "recover from an error",
}
"""The skills that arms serve under their own name; those of other devices are words already: `grasp`, `attach_part`."""

Capability = Literal[
    "trajectory", "stream", "torque", "contact", "force", "guide", "reflex", "outputs", "gripper", "hand"
]

CAPABILITIES: Mapping[Capability, str] = {
    "trajectory": "sampled trajectories",
    "stream": "streamed set points",
    "torque": "impedance control",
    "contact": "measured contact forces",
    "force": "force control",
    "guide": "hand guiding",
    "reflex": "the collision reflex",
    "outputs": "digital outputs",
    "gripper": "gripper commands",
    "hand": "hand commands",
}
"""What a driver can do, in words, as messages say it."""

_ADDRESS = re.compile(r"(?!root/)[A-Za-z]\w*(?:/[A-Za-z]\w*)+")
_ARM = re.compile(r"(?:^|_)arm(?:_|\d|$)")


class Skill(msgspec.Struct, Generic[R], frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of services and actions; subclass `Service` or `Action`."""

    capability: ClassVar[Capability | None] = None
    """What the driver of the device must be able to do; None for nothing in particular."""

    @classmethod
    def skill_name(cls) -> str:
        """Return the last part of the bus address: the class name in snake case."""
        return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", cls.__name__).lower()

    @classmethod
    def result_type(cls) -> Any:
        """Return the result type of this skill."""
        return _type_arguments(cls)[0]

    def address(self, to: str) -> str:
        """Return the bus address of this request to the namespace `to`."""
        return f"{to}/{self.skill_name()}"

    def data(self) -> object:
        """Return the fields of this request as plain data."""
        return msgspec.to_builtins(self)


class Service(Skill[R], Generic[R], frozen=True, kw_only=True):
    """A request with a single, immediate response."""

    @property
    def ends_run(self) -> bool:
        """Whether the run that has the resource is ended for this request, instead of refusing it."""
        return False


class Action(Skill[R], Generic[R, F], frozen=True, kw_only=True):
    """A goal that takes time: it is accepted or rejected, sends feedback, and can be held and cancelled."""

    @classmethod
    def feedback_type(cls) -> Any:
        """Return the type of the feedback messages."""
        return _type_arguments(cls)[1]


class NamedService(Service[object], frozen=True, kw_only=True):
    """A service request given by name and fields; its response is plain data. The bus knows its type."""

    name: str
    fields: Mapping[str, object]

    def address(self, to: str) -> str:
        """Return the bus address of this request to the namespace `to`."""
        return f"{to}/{self.name}"

    def data(self) -> object:
        """Return the fields."""
        return self.fields


class NamedAction(Action[object, object], frozen=True, kw_only=True):
    """A goal given by name and fields; its result is plain data. The bus knows its type."""

    name: str
    fields: Mapping[str, object]

    def address(self, to: str) -> str:
        """Return the bus address of this goal to the namespace `to`."""
        return f"{to}/{self.name}"

    def data(self) -> object:
        """Return the fields."""
        return self.fields


def required_capability(name: str) -> Capability | None:
    """Return what the driver must be able to do for a skill, by its name on the bus; None for nothing, or no skill."""
    pending: list[type[Skill[Any]]] = [Skill]
    while pending:
        skill = pending.pop()
        if skill.capability is not None and skill.skill_name() == name:
            return skill.capability
        pending.extend(skill.__subclasses__())
    return None


def skill_words(address: str) -> str:
    """Return device and skill of an address in words: `left arm: line to a pose`, `left gripper: grasp`.

    Empty for what is no address, such as the path of a node or a position in a file.
    """
    if not _ADDRESS.fullmatch(address):
        return ""
    owner, *tools, name = address.split("/")
    title = ARM_SKILL_TITLES.get(name)
    if title is not None and not tools:
        return f"{owner}: {title}" if _ARM.search(owner) else f"{owner} arm: {title}"
    name = name.removeprefix(f"{tools[-1]}_") if tools else name
    return f"{' '.join([owner, *tools])}: {name.replace('_', ' ')}"


def activity_words(activity: str) -> str:
    """Return what an arm does in words: `line to a pose` for a skill, what is no skill of an arm as it is."""
    return ARM_SKILL_TITLES.get(activity, activity)


def _type_arguments(cls: type[Any]) -> tuple[Any, ...]:
    for ancestor in cls.__mro__:
        for base in getattr(ancestor, "__orig_bases__", ()):
            if get_origin(base) in (Service, Action):
                arguments = get_args(base)
                if not any(isinstance(a, TypeVar) for a in arguments):
                    return arguments
    raise TypeError(f"{cls.__name__} must derive from Service[Result] or Action[Result, Feedback]")
