"""Applies the external interventions of the recorded run to the replay: stops, commands, an operator."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Mapping
from typing import Any

import msgspec

from engine.errors import Cause, FlexcellError, RecordingError
from engine.event import BehaviorChanged, OperatorChanged, OperatorCommanded, StopRequested
from engine.replay.expected_events import Intervention, OutsideEvent
from engine.replay.recorded_errors import error_from_cause
from engine.runtime.control import Breakpoint, Control
from engine.runtime.history.hot_change import VersionSnapshot
from engine.runtime.plan import Plan
from engine.runtime.run import Run

_COMMANDS: Mapping[str, Callable[[Control, OperatorCommanded], None]] = {
    "pause": lambda control, _: control.pause(),
    "resume": lambda control, _: control.resume(),
    "step": lambda control, event: control.step(_text(event, "mode"), event.path),
    "lock": lambda control, event: control.lock(event.path, _text(event, "reason")),
    "unlock": lambda control, event: control.unlock(event.path),
    "force": lambda control, event: control.force(event.path, _text(event, "outcome")),
    "repeat": lambda control, event: control.repeat(event.path),
    "answer": lambda control, event: control.answer(event.path),
    "set_userdata": lambda control, event: control.set_userdata(event.path, _text(event, "key"), _text(event, "value")),
    "autonomy": lambda control, event: control.set_autonomy(_text(event, "level")),
    "breakpoints": lambda control, event: control.set_breakpoints(_breakpoints(event)),
}
_STEP_BACK = "step_back"
_OPERATOR: Mapping[str, Callable[[Control], None]] = {
    "attached": Control.attach_operator,
    "detached": Control.detach_operator,
    "lost": Control.lose_operator,
}


def require_known(event: OutsideEvent) -> None:
    """Reject interventions that cannot be replayed.

    Raises:
        RecordingError: this version does not know the command.
    """
    if isinstance(event, OperatorCommanded) and event.command not in (*_COMMANDS, _STEP_BACK):
        raise RecordingError(f"event {event.seq}: the command `{event.command}` cannot be replayed")


def apply_intervention(run: Run, each: Intervention, versions: Mapping[int, Plan]) -> None:
    """Repeat an intervention; raises ControlError if the run does not permit it now.

    Args:
        run: The replayed run.
        each: The intervention in the recorded run.
        versions: New versions of its hot changes, by the number of the event.
    """
    match each.event:
        case BehaviorChanged() as event:
            kept = VersionSnapshot(behavior=event.behavior, documents=event.documents)
            run.change(versions[event.seq], preempt=event.preempt, kept=kept)
        case StopRequested() as event:
            if each.failure is not None:
                run.fail(_error(event, each.failure))
            else:
                run.stop(event.reason)
        case OperatorChanged() as event:
            _OPERATOR[event.status](run.control)
        case OperatorCommanded(command=name) as event if name == _STEP_BACK:
            _at_once(run.step_back(event.path))
        case OperatorCommanded() as event:
            _COMMANDS[event.command](run.control, event)


def _at_once(order: Coroutine[Any, Any, object]) -> None:
    """Carry out what waits for nothing where events are kept in memory and time is virtual."""
    try:
        order.send(None)
    except StopIteration:
        return
    order.close()
    raise RecordingError("a step back waited for something, which a replay does not have")


def _error(event: StopRequested, failure: Cause) -> FlexcellError:
    """Return the error with its message and its hint apart again, as the stop says only the message."""
    error = error_from_cause(failure)
    error.hint = error.message.removeprefix(event.reason).removeprefix(" (").removesuffix(")") or None
    error.message = event.reason
    return error


def _text(event: OperatorCommanded, name: str) -> Any:
    return event.arguments.get(name, "")


def _breakpoints(event: OperatorCommanded) -> tuple[Breakpoint, ...]:
    return msgspec.convert(event.arguments.get("breakpoints", ()), tuple[Breakpoint, ...])
