"""Events survive the journal unchanged, and equal events are equal bytes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import Cause, JournalError
from engine.event import AnyEvent, GoalSent, MessageLogged, NodeEntered, NodeExited, RunEnded, UserdataWritten
from engine.journal import decode_event, encode_event, encode_event_log
from engine.messages import Pose
from tests.engine.json_values import JSON, TEXT

CAUSES = st.recursive(
    st.builds(Cause, message=TEXT, where=TEXT, kind=TEXT),
    lambda inner: st.builds(Cause, message=TEXT, because=inner),
    max_leaves=4,
)
HEAD = {"seq": st.integers(1, 2**53), "time_s": st.floats(0, 1e9)}
EVENTS: st.SearchStrategy[AnyEvent] = st.one_of(
    st.builds(NodeEntered, **HEAD, path=TEXT, visit=st.integers(1, 99), kind=TEXT, inputs=st.dictionaries(TEXT, JSON)),
    st.builds(UserdataWritten, **HEAD, path=TEXT, scope=TEXT, key=TEXT, value=JSON),
    st.builds(NodeExited, **HEAD, path=TEXT, visit=st.integers(1, 99), outcome=TEXT, cause=st.none() | CAUSES),
    st.builds(RunEnded, **HEAD, status=TEXT, outcome=st.none() | TEXT, cause=st.none() | CAUSES),
)


@given(EVENTS)
def test_any_event_comes_back_as_it_was(event: AnyEvent) -> None:
    """Encoding loses nothing that JSON can hold."""
    assert decode_event(encode_event(event)) == event


@given(st.dictionaries(TEXT, JSON, min_size=2, max_size=5))
def test_the_order_of_dictionary_keys_does_not_change_the_bytes(inputs: dict[str, object]) -> None:
    """Two runs that build the same request in another order give the same log."""

    def logged(request: dict[str, object]) -> bytes:
        return encode_event_log(
            [GoalSent(seq=1, time_s=0.5, path="root/a", goal="g1", address="left/x", request=request)]
        )

    assert logged(dict(reversed(inputs.items()))) == logged(inputs)


def test_the_log_is_one_line_for_each_event() -> None:
    """The exact bytes are a format: whoever changes them breaks every recording."""
    events = [
        MessageLogged(seq=1, time_s=0.0, path="root", level="info", message="two\nlines"),
        NodeExited(seq=2, time_s=1.25, path="root", visit=1, outcome="done"),
    ]
    assert encode_event_log(events) == (
        b'{"event":"log","seq":1,"time_s":0.0,"path":"root","level":"info","message":"two\\nlines"}\n'
        b'{"event":"exited","seq":2,"time_s":1.25,"path":"root","visit":1,"outcome":"done"}\n'
    )


def test_a_message_inside_userdata_is_written_by_its_fields() -> None:
    """A pose in userdata comes back as a dictionary that still reads as a pose."""
    event = UserdataWritten(seq=1, time_s=0.0, path="root/a", scope="root", key="goal", value=Pose(xyz=(1.0, 2.0, 3.0)))
    read = decode_event(encode_event(event))
    assert isinstance(read, UserdataWritten)
    assert read.value == {"xyz": [1.0, 2.0, 3.0], "xyzw": [0.0, 0.0, 0.0, 1.0], "frame": "world"}


@pytest.mark.parametrize("value", [object(), {1j}, "\ud800"])
def test_what_json_cannot_hold_is_named_with_its_event(value: object) -> None:
    """An object, a complex number or broken text in userdata is reported with seq, kind and path."""
    event = UserdataWritten(seq=7, time_s=0.0, path="root/a", scope="root", key="goal", value=value)
    with pytest.raises(JournalError, match=r"root/a: event 7 \(UserdataWritten\) cannot be written"):
        encode_event(event)


@given(st.binary(max_size=40))
def test_garbage_is_refused_as_no_event(data: bytes) -> None:
    """A damaged line raises the one kind of error, never another."""
    with pytest.raises(JournalError, match="not an event"):
        decode_event(data)
