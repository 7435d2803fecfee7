"""Live view, past and resume are views of one state: they agree on any sequence of events."""

from __future__ import annotations

from collections.abc import Mapping

from hypothesis import example, given, settings
from hypothesis import strategies as st

from editor_web.past.state_history import RunStateHistory
from engine.event import Event, NodeEntered, NodeExited, RunResumed, RunStarted
from engine.runtime.history.live_run import LiveRun
from engine.runtime.history.resume import read_history
from engine.runtime.history.run_state import IDLE, NodeLive
from tests.editor_web.past.events import PATHS, STEPS, made_up
from tests.engine.run_document import plan_of

GIVE = "{state: test.Give, transitions: {a: good, b: good, c: bad}}"
PLAN = plan_of(
    f"""
    root:
      machine:
        initial: a
        states:
          a: {GIVE}
          c: {GIVE}
          b:
            machine:
              initial: x
              states:
                x: {GIVE}
                y: {{machine: {{initial: deep, states: {{deep: {GIVE}}}}}, transitions: {{good: good, bad: bad}}}}
            transitions: {{good: good, bad: bad}}
    """
)


@settings(deadline=None, max_examples=100)
@example(steps=[("enter", "root", 0.0), ("resume", "root", 0.5), ("exit", "root", 0.0)], ended=False)
@example(steps=[("enter", "root/b", 0.0), ("follow", "root/b", 0.0)], ended=False)
@example(
    steps=[("enter", "root/a", 0.0), ("exit", "root/a", 0.0), ("retry", "root", 0.0), ("preempt", "root", 0.0)],
    ended=False,
)
@given(steps=STEPS, ended=st.booleans())
def test_live_past_and_resume_see_the_same_run(steps: list[tuple[str, str, float]], ended: bool) -> None:
    """Nodes, what is active, which exits wait for their container, and what the operator has set."""
    assert set(PATHS) <= set(PLAN.nodes)
    events = made_up(steps, ended=ended)
    live, past = LiveRun("r"), RunStateHistory("r")
    for event in events:
        live.apply(event)
        past.follow(event)
    resumable = read_history(PLAN, "r", events)
    state = resumable.state
    shown = past.at(events[-1].seq).nodes
    assert not_idle(shown) == not_idle(past.now.nodes) == not_idle(live.state.nodes) == not_idle(state.nodes)
    for other in (live.state, past.now):
        assert (list(other.active), other.exits) == (list(state.active), state.exits)
        assert (other.paused, other.locks, other.autonomy) == (state.paused, state.locks, state.autonomy)
        assert (other.stepping_back, other.document, other.end) == (state.stepping_back, state.document, state.end)
    points = resumable.checkpoint().points
    assert {path for path, point in points.items() if point.active and point.entered} == set(state.active)
    left = {path for path, point in points.items() if not point.active}
    assert left - {"root"} == {f"{path}/{name}" for path, names in state.exits.items() for name in names}


def not_idle(nodes: Mapping[str, NodeLive]) -> dict[str, NodeLive]:
    """Return the nodes of which there is something to tell; a resume may have taken all of it back."""
    return {path: node for path, node in nodes.items() if node != IDLE}


def entered(seq: int, path: str, visit: int = 1) -> Event:
    return NodeEntered(seq=seq, time_s=float(seq), path=path, visit=visit, kind="state", inputs={})


def test_what_a_resume_takes_back_is_not_shown_any_more() -> None:
    """The world was restored to an earlier instant: what was entered after it is not active."""
    events: list[Event] = [
        RunStarted(seq=1, time_s=0.0, behavior="b", document="d", parameters={}, seed=1, clock="virtual"),
        entered(2, "root"),
        entered(3, "root/a"),
        NodeExited(seq=4, time_s=4.0, path="root/a", visit=1, outcome="done"),
        entered(5, "root/b"),
        RunResumed(seq=6, time_s=3.0, after_seq=3, epoch=2, rerun=("root/a",)),
        entered(7, "root/a", visit=2),
    ]
    live, past = LiveRun("r"), RunStateHistory("r")
    changed = [live.apply(event) for event in events]
    for event in events:
        past.follow(event)
    for nodes in (live.state.nodes, past.now.nodes, past.at(7).nodes):
        assert {path for path, node in nodes.items() if node.status == "active"} == {"root", "root/a"}
    assert past.at(5).nodes["root/b"].status == "active"
    rewound = changed[5]
    assert rewound is not None
    assert {path: node.status for path, node in rewound.nodes.items()} == {"root/a": "active", "root/b": "idle"}
