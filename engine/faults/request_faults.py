"""Faults of requests with one response: a service call, or the read of a topic."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Generic, TypeVar

from engine.errors import FlexcellError, SkillFailed
from engine.faults.fault_context import FaultContext
from engine.faults.fault_rule import FaultRule

R = TypeVar("R")


@dataclass(frozen=True)
class RepeatableRequest(Generic[R]):
    """A request of the state at `path` to `address`; each call of `ask` sends it."""

    path: str
    address: str
    ask: Callable[[], Awaitable[R]]


async def apply_request_fault(rule: FaultRule, question: RepeatableRequest[R], scene: FaultContext) -> R:
    """Apply a fault to a request; raises the errors of the fault or of the server."""
    match rule.fault.kind:
        case "late":
            return await _late(rule, question, scene)
        case "error":
            return await _fail(rule, question, scene)
        case "duplicate":
            return await _twice(rule, question, scene)
        case "crash":
            return await _killed(rule, question, scene)
        case "device":
            # Devices break when they are told to move; reading them is not what breaks them.
            return await question.ask()
        case "lost" | "hang":
            return await _never(rule, question, scene)


async def _late(rule: FaultRule, question: RepeatableRequest[R], scene: FaultContext) -> R:
    delay_s = rule.fault.late_s
    scene.apply(rule, question.path, question.address, f"the response is {delay_s:g} s late")
    try:
        answered = await question.ask()
    except FlexcellError:
        await scene.clock.sleep(delay_s)
        raise
    await scene.clock.sleep(delay_s)
    return answered


async def _fail(rule: FaultRule, question: RepeatableRequest[R], scene: FaultContext) -> R:
    message, after_s = rule.failure.message, rule.failure.after_s
    scene.apply(rule, question.path, question.address, f"fails: {message}")
    if after_s:
        await scene.clock.sleep(after_s)
    raise SkillFailed(message, where=question.address)


async def _twice(rule: FaultRule, question: RepeatableRequest[R], scene: FaultContext) -> R:
    scene.apply(rule, question.path, question.address, "asked twice")
    try:
        answered = await question.ask()
    except FlexcellError:
        await _again(rule, question, scene)
        raise
    await _again(rule, question, scene)
    return answered


async def _again(rule: FaultRule, question: RepeatableRequest[R], scene: FaultContext) -> None:
    try:
        await question.ask()
    except FlexcellError as error:
        # The state does not know of the copy; only its effect and this line show it.
        scene.note(rule, question.path, question.address, f"the copy of the request failed: {error}")


async def _killed(rule: FaultRule, question: RepeatableRequest[R], scene: FaultContext) -> R:
    before = rule.fault.crash is not None and rule.fault.crash.on_request == "before"
    scene.apply(rule, question.path, question.address, "killed before it is asked" if before else "killed afterwards")
    if before:
        scene.kill()
        return await question.ask()
    answered = await question.ask()
    scene.kill()
    return answered


async def _never(rule: FaultRule, question: RepeatableRequest[R], scene: FaultContext) -> R:
    if rule.fault.lost == "request":
        scene.apply(rule, question.path, question.address, "the request is lost")
    else:
        scene.apply(rule, question.path, question.address, "the response is lost" if rule.fault.lost else "no response")
        # An error is a response too, and the response is lost.
        with suppress(FlexcellError):
            await question.ask()
    while True:
        try:
            await asyncio.get_running_loop().create_future()
        except asyncio.CancelledError:
            # A request that ignores cancels still ends when the loop closes; otherwise the process would never exit.
            if scene.over or not rule.ignores_cancel:
                raise
