"""Handlers are refused when they are offered, not when the first goal comes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from engine.bus import ActiveGoal, GoalHandle
from engine.bus.handler_signature import expected_signature, verify_handler
from engine.errors import HandlerNotTyped
from engine.messages import GripperState
from engine.skills.gripper import GraspResult, GripperFeedback, GripperOpen, ReadGripper


async def right(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
    raise NotImplementedError


async def with_options(goal: GripperOpen, handle: ActiveGoal[GripperFeedback], speed: float = 1.0) -> GraspResult:
    raise NotImplementedError


async def other_goal(goal: ReadGripper, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
    raise NotImplementedError


async def other_feedback(goal: GripperOpen, handle: ActiveGoal[GripperState]) -> GraspResult:
    raise NotImplementedError


async def other_handle(goal: GripperOpen, handle: GoalHandle[GraspResult, GripperFeedback]) -> GraspResult:
    raise NotImplementedError


async def bare_handle(goal: GripperOpen, handle: ActiveGoal) -> GraspResult:  # pyright: ignore[reportMissingTypeArgument, reportUnknownParameterType]
    raise NotImplementedError


async def no_handle(goal: GripperOpen) -> GraspResult:
    raise NotImplementedError


async def one_more(goal: GripperOpen, handle: ActiveGoal[GripperFeedback], speed: float) -> GraspResult:
    raise NotImplementedError


async def other_result(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GripperState:
    raise NotImplementedError


async def unknown_type(goal: GripperOpen, handle: ActiveGoal[Nothing]) -> GraspResult:  # noqa: F821 # pyright: ignore[reportUndefinedVariable, reportUnknownParameterType]
    raise NotImplementedError


WRONG: list[Callable[..., Any]] = [
    other_goal, other_feedback, other_handle, bare_handle, no_handle, one_more, other_result, unknown_type,  # pyright: ignore[reportUnknownVariableType]
]  # fmt: skip
SIGNATURE = "async def handler(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult"


@pytest.mark.parametrize("handler", [right, with_options])
def test_a_handler_with_the_types_of_its_skill_is_taken(handler: Callable[..., Any]) -> None:
    """Parameters with defaults are its own affair."""
    verify_handler(GripperOpen, handler, "left/gripper/gripper_open")


@pytest.mark.parametrize("handler", WRONG)
def test_a_handler_with_other_types_is_refused_with_the_signature_that_is_due(handler: Callable[..., Any]) -> None:
    with pytest.raises(HandlerNotTyped) as refused:
        verify_handler(GripperOpen, handler, "left/gripper/gripper_open")
    assert (refused.value.where, refused.value.hint) == ("left/gripper/gripper_open", f"write it as {SIGNATURE}")
    assert handler.__name__ in refused.value.message


def test_the_signature_of_a_service_has_its_request_and_its_answer() -> None:
    assert expected_signature(ReadGripper) == "async def handler(request: ReadGripper) -> GripperState"
    assert expected_signature(GripperOpen) == SIGNATURE
