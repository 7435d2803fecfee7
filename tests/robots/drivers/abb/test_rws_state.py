"""What Robot Web Services answer: each value, the cause that follows from it, and any other bytes."""

from __future__ import annotations

from contextlib import suppress

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.drivers.abb.abb_faults import AbbFault, AbbLinkError
from robots.drivers.abb.rws.rws_faults import rws_fault
from robots.drivers.abb.rws.rws_state import (
    ControllerEvent,
    ModeSelector,
    PanelState,
    RapidExecution,
    RwsIdentity,
    RwsState,
    SignalUnknown,
    digital_signal,
    error_text,
    latest_error,
    mode_selector,
    panel_state,
    rapid_execution,
    rws_identity,
    speed_share,
)
from tests.tiers import examples

MANY = settings(max_examples=examples(200, nightly=2_000), deadline=None)
IDENTITY = RwsIdentity(name="cell", serial="1", robotware="6.15", system="s")
DECODERS = (panel_state, mode_selector, rapid_execution, speed_share, latest_error, digital_signal)
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=10,
)
RESOURCE = st.dictionaries(
    st.sampled_from(
        [
            "ctrlstate",
            "opmode",
            "ctrlexecstate",
            "speedratio",
            "_title",
            "msgtype",
            "code",
            "title",
            "type",
            "lvalue",
            "phstate",
            "lstate",
        ]
    ),
    JSON | st.sampled_from(["DI", "1"]),
)


def answer(*resources: object) -> bytes:
    """Return an answer with resources."""
    return msgspec.json.encode({"_embedded": {"_state": resources}})


def state(
    panel: PanelState = "motoron",
    mode: ModeSelector = "AUTO",
    execution: RapidExecution = "running",
    event: ControllerEvent | None = None,
) -> RwsState:
    """Return the state of a controller."""
    return RwsState(panel=panel, mode=mode, execution=execution, speed_share=1.0, latest_error=event, identity=IDENTITY)


@pytest.mark.parametrize(
    ("read", "fault"),
    [
        (state(), None),
        (state("emergencystop", "MANR", "stopped"), AbbFault.EMERGENCY_STOP),
        (state("emergencystopreset", execution="stopped"), AbbFault.EMERGENCY_STOP),
        (state("sysfail"), AbbFault.CONTROLLER_ERROR),
        (state("guardstop", "MANR", "stopped"), AbbFault.MANUAL_MODE),
        (state("guardstop", execution="stopped"), AbbFault.GUARD_STOP),
        (state("motoroff", execution="stopped"), AbbFault.DRIVES_OFF),
        (state("init", "INIT", "stopped"), AbbFault.MANUAL_MODE),
        (state(mode="AUTO_CH"), AbbFault.MANUAL_MODE),
        (state(execution="stopped"), AbbFault.PROGRAM_STOPPED),
    ],
)
def test_the_first_cause_is_the_one_that_a_person_ends_first(read: RwsState, fault: AbbFault | None) -> None:
    found = rws_fault(read, since_event=0)
    assert (found[0] if found is not None else None) is fault


def test_only_an_event_that_came_since_is_part_of_the_cause() -> None:
    event = ControllerEvent(number=7, kind=3, code=50027, title="Joint out of range")
    stopped = state(execution="stopped", event=event)
    assert rws_fault(stopped, since_event=6) == (
        AbbFault.PROGRAM_STOPPED,
        "RAPID is stopped; event 50027: Joint out of range",
    )
    assert rws_fault(stopped, since_event=7) == (AbbFault.PROGRAM_STOPPED, "RAPID is stopped")
    assert rws_fault(state(event=event), since_event=0) is None


def test_each_value_is_read() -> None:
    assert panel_state(answer({"ctrlstate": "guardstop"})) == "guardstop"
    assert mode_selector(answer({"opmode": "MANF"})) == "MANF"
    assert rapid_execution(answer({"ctrlexecstate": "stopped", "cycle": "once"})) == "stopped"
    assert speed_share(answer({"speedratio": "35"})) == 0.35
    assert (
        rws_identity(
            identity=answer({"ctrl-name": "cell", "ctrl-id": "1"}), system=answer({"name": "s", "rwversion": "6.15"})
        )
        == IDENTITY
    )
    assert error_text(b'{"_embedded": {"status": {"code": "-5", "msg": "not allowed"}}}') == "not allowed (code -5)"
    assert error_text(b"<html>") == ""


SIGNAL = {"type": "DI", "lvalue": "1", "lstate": "not simulated", "phstate": "valid", "unitnm": "PANEL"}


def test_a_digital_signal_has_its_logical_value_also_where_a_person_simulates_it() -> None:
    assert digital_signal(answer(SIGNAL)) is True
    assert digital_signal(answer({**SIGNAL, "lvalue": "0", "type": "DO"})) is False
    assert digital_signal(answer({**SIGNAL, "phstate": "invalid", "lstate": "simulated"})) is True


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"phstate": "invalid"}, "its device 'PANEL' tells no valid value"),
        ({"type": "AI"}, "it is of the type 'AI', not a digital one"),
    ],
)
def test_a_signal_without_a_valid_digital_value_is_unknown(given: dict[str, str], reason: str) -> None:
    with pytest.raises(SignalUnknown, match=reason):
        digital_signal(answer(SIGNAL | given))


def test_a_value_that_no_digital_signal_has_is_garbage() -> None:
    with pytest.raises(AbbLinkError, match="2 as the value of a digital signal"):
        digital_signal(answer({**SIGNAL, "lvalue": "2"}))


@pytest.mark.parametrize("order", [1, -1])
def test_the_latest_error_is_found_in_either_order_of_the_log(order: int) -> None:
    log = [
        {"_title": f"/rw/elog/0/{number}", "msgtype": kind, "code": str(number), "title": f"event {number}"}
        for number, kind in ((9, "3"), (10, "3"), (11, "1"))
    ][::order]
    assert latest_error(answer(*log)) == ControllerEvent(number=10, kind=3, code=10, title="event 10")
    assert latest_error(answer({"_title": "/rw/elog/0/11", "msgtype": "1", "code": "11"})) is None
    assert latest_error(answer()) is None


@MANY
@given(st.binary(max_size=200) | JSON.map(msgspec.json.encode) | st.lists(RESOURCE).map(lambda all_: answer(*all_)))
def test_any_answer_is_read_or_refused(body: bytes) -> None:
    for decode in DECODERS:
        with suppress(AbbLinkError, SignalUnknown):
            decode(body)
    error_text(body)
