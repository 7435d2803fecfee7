"""What Robot Web Services answer: one value for each resource; what is no answer is garbage."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, cast, get_args

import msgspec

from robots.drivers.abb.abb_faults import AbbFault, AbbLinkError

PanelState = Literal["init", "motoroff", "motoron", "guardstop", "emergencystop", "emergencystopreset", "sysfail"]
ModeSelector = Literal["INIT", "AUTO_CH", "MANF_CH", "MANR", "MANF", "AUTO", "UNDEF"]
RapidExecution = Literal["running", "stopped"]
ERROR_EVENT = 3
"""`msgtype` of an error; 1 is information, 2 a warning."""

Resource = Mapping[str, object]


@dataclass(frozen=True, kw_only=True)
class RwsIdentity:
    """The names of a controller."""

    name: str
    serial: str
    robotware: str
    system: str


@dataclass(frozen=True, kw_only=True)
class ControllerEvent:
    """An entry of the event log."""

    number: int
    kind: int
    code: int
    title: str


@dataclass(frozen=True, kw_only=True)
class RwsState:
    """The state of a controller.

    Attributes:
        panel: The controller state: motors, safeguards, emergency stop.
        mode: The mode selector.
        execution: Whether the normal tasks run.
        speed_share: The speed of the panel, 0 to 1.
        latest_error: Of the event log; None without an error.
        identity: Read once for each connection.
        inputs: Values of the signals that are its digital inputs; empty with `inputs_problem`.
        inputs_problem: Why a signal is not known; empty if all are.
    """

    panel: PanelState
    mode: ModeSelector
    execution: RapidExecution
    speed_share: float
    latest_error: ControllerEvent | None
    identity: RwsIdentity
    inputs: tuple[bool, ...] = ()
    inputs_problem: str = ""


class SignalUnknown(Exception):
    """A signal has no value of an input; says why."""


def resources(body: bytes) -> Sequence[Resource]:
    """Return the resources in an answer; raises AbbLinkError."""
    try:
        answer: Any = msgspec.json.decode(body)
        states = answer["_embedded"]["_state"]
    except (msgspec.DecodeError, KeyError, TypeError, UnicodeDecodeError) as error:
        raise garbage(f"an answer that is none: {body[:40]!r}") from error
    if not isinstance(states, list) or not all(isinstance(state, dict) for state in cast("list[object]", states)):
        raise garbage("an answer without a list of resources")
    return cast("list[Resource]", states)


def first(body: bytes) -> Resource:
    """Return the only resource in an answer; raises AbbLinkError."""
    states = resources(body)
    if not states:
        raise garbage("an answer without a resource")
    return states[0]


def panel_state(body: bytes) -> PanelState:
    """Decode `/rw/panel/ctrlstate`; raises AbbLinkError."""
    return cast("PanelState", _one_of(body, "ctrlstate", get_args(PanelState)))


def mode_selector(body: bytes) -> ModeSelector:
    """Decode `/rw/panel/opmode`; raises AbbLinkError."""
    return cast("ModeSelector", _one_of(body, "opmode", get_args(ModeSelector)))


def rapid_execution(body: bytes) -> RapidExecution:
    """Decode `/rw/rapid/execution`; raises AbbLinkError."""
    return cast("RapidExecution", _one_of(body, "ctrlexecstate", get_args(RapidExecution)))


def speed_share(body: bytes) -> float:
    """Decode `/rw/panel/speedratio`, in percent; raises AbbLinkError."""
    percent = _integer(first(body), "speedratio")
    if not 0 <= percent <= 100:
        raise garbage(f"a speed ratio of {percent} %")
    return percent / 100.0


def latest_error(body: bytes) -> ControllerEvent | None:
    """Decode `/rw/elog/0`, in any order; raises AbbLinkError."""
    events = (_event(resource) for resource in resources(body))
    errors = [event for event in events if event.kind == ERROR_EVENT]
    return max(errors, key=lambda event: event.number, default=None)


def digital_signal(body: bytes) -> bool:
    """Decode `/rw/iosystem/signals/…`: the logical value, which a person may have simulated at the controller.

    Raises:
        SignalUnknown: it is no digital signal, or its device is not there.
        AbbLinkError: the answer is none.
    """
    signal = first(body)
    kind = signal.get("type")
    if kind not in ("DI", "DO"):
        raise SignalUnknown(f"it is of the type {kind!r:.10}, not a digital one")
    # A simulated one has a value although its device is not there.
    if signal.get("lstate") != "simulated" and signal.get("phstate", "valid") != "valid":
        raise SignalUnknown(f"its device {signal.get('unitnm', '')!r:.40} tells no valid value")
    value = _integer(signal, "lvalue")
    if value not in (0, 1):
        raise garbage(f"{value} as the value of a digital signal")
    return value == 1


def rws_identity(*, identity: bytes, system: bytes) -> RwsIdentity:
    """Decode `/ctrl/identity` and `/rw/system`; raises AbbLinkError."""
    names, software = first(identity), first(system)
    return RwsIdentity(
        name=str(names.get("ctrl-name", "")),
        serial=str(names.get("ctrl-id", "")),
        robotware=str(software.get("rwversion", "")),
        system=str(software.get("name", "")),
    )


def error_text(body: bytes) -> str:
    """Return why a request was refused, as far as the answer says it."""
    try:
        status = msgspec.json.decode(body)["_embedded"]["status"]
        return f"{status['msg']} (code {status['code']})"
    except (msgspec.DecodeError, KeyError, TypeError, UnicodeDecodeError):
        return ""


def garbage(detail: str) -> AbbLinkError:
    """Return the error of an answer that is none."""
    return AbbLinkError(AbbFault.GARBAGE, f"RWS sent {detail}")


def _one_of(body: bytes, key: str, known: tuple[str, ...]) -> str:
    value = first(body).get(key)
    if not isinstance(value, str) or value not in known:
        raise garbage(f"{value!r:.40} as `{key}`")
    return value


def _integer(resource: Resource, key: str) -> int:
    value = resource.get(key)
    try:
        return int(cast("str", value))
    except (TypeError, ValueError, OverflowError) as error:
        raise garbage(f"{value!r:.40} as `{key}`") from error


def _event(resource: Resource) -> ControllerEvent:
    title = str(resource.get("_title", "")).rpartition("/")[2]
    try:
        number = int(title)
    except ValueError as error:
        raise garbage(f"an event without a number: {title!r:.40}") from error
    return ControllerEvent(
        number=number,
        kind=_integer(resource, "msgtype"),
        code=_integer(resource, "code"),
        title=str(resource.get("title", ""))[:120],
    )
