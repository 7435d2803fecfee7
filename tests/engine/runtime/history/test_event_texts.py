"""Every event has its words, each of them is used, and page and command line say the same."""

from __future__ import annotations

import io
from typing import get_args

import msgspec
import pytest
from rich.console import Console

from engine.cli.output.progress_printer import ProgressPrinter
from engine.errors import Cause
from engine.event import (
    AnyEvent,
    Event,
    FaultInjected,
    MessageLogged,
    NodeEntered,
    NodeExited,
    NodeRetried,
    RunEnded,
    StopRequested,
)
from engine.runtime.history.event_texts import EVENT_TEXTS, event_text
from engine.runtime.history.live_run import LiveRun

EVENTS: list[type[Event]] = list(get_args(AnyEvent))
_SAMPLES: dict[str, object] = {
    "<class 'int'>": 1,
    "<class 'float'>": 1.0,
    "dict[str, object]": {},
    "tuple[str, ...]": (),
}


def sample(kind: type[Event]) -> Event:
    """Return an event of a class, with its required fields."""
    given: dict[str, object] = {"seq": 1, "time_s": 0.0, "event": kind.__struct_config__.tag}
    for field in msgspec.structs.fields(kind):
        if field.required and field.name not in given:
            given[field.name] = _SAMPLES.get(str(field.type), "x")
    return msgspec.convert(given, kind)


@pytest.mark.parametrize("kind", EVENTS, ids=[kind.__name__ for kind in EVENTS])
def test_every_kind_of_event_has_its_words(kind: type[Event]) -> None:
    """The name of a class is no sentence; a new kind of event needs its words, under its tag."""
    assert event_text(sample(kind)).text != kind.__name__
    tag = kind.__struct_config__.tag
    assert any(id_.partition(".")[0] == tag for id_ in EVENT_TEXTS)


def test_every_message_belongs_to_an_event() -> None:
    """So that no words are left of an event that is gone."""
    tags = {kind.__struct_config__.tag for kind in EVENTS}
    assert {id_ for id_ in EVENT_TEXTS if id_.partition(".")[0] not in tags} == set()


def test_the_duration_of_a_node_is_left_out_where_it_is_not_known() -> None:
    event = NodeExited(seq=1, time_s=3.0, path="root/a", visit=1, outcome="done")
    assert event_text(event).text == "ended with done"
    assert event_text(event, duration_s=1.5).text == "ended with done after 1.50 s"


def test_page_and_command_line_say_the_same() -> None:
    """Of what both of them show: states that end, faults, retries, logs, a stop and the end."""
    events = [
        NodeEntered(seq=1, time_s=0.0, path="root", visit=1, kind="machine", inputs={}),
        NodeEntered(seq=2, time_s=0.0, path="root/a", visit=1, kind="state", inputs={}),
        MessageLogged(seq=3, time_s=0.5, path="root/a", level="warning", message="two [parts] are gone"),
        FaultInjected(seq=4, time_s=0.5, path="root/a", address="left/move_free", fault="reject", detail="once"),
        NodeExited(seq=5, time_s=1.0, path="root/a", visit=1, outcome="", cause=Cause(message="lost")),
        NodeRetried(seq=6, time_s=1.0, path="root/a", attempt=2, wait_s=0.25),
        NodeEntered(seq=7, time_s=1.25, path="root/a", visit=2, kind="state", inputs={}),
        StopRequested(seq=8, time_s=2.0, reason="enough"),
        NodeExited(seq=9, time_s=2.0, path="root/a", visit=2, outcome="", preempted=True),
        NodeExited(seq=10, time_s=2.0, path="root", visit=1, outcome="", preempted=True),
        RunEnded(seq=11, time_s=2.0, status="stopped"),
    ]
    printed = io.StringIO()
    printer, live = ProgressPrinter(Console(file=printed, width=200)), LiveRun("r")
    for event in events:
        printer.show(event)
        live.apply(event)
    shown = [
        line for line in live.log if line.kind != "entered" and not (line.kind == "exited" and line.path == "root")
    ]
    assert [line.split(" s  ", 1)[1] for line in printed.getvalue().splitlines()] == [
        f"{line.path}  {line.text}" if line.path else line.text for line in shown
    ]
