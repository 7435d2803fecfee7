"""Runs made up of events as an engine could tell them: nodes entered, left, diverted, commanded, in any order."""

from __future__ import annotations

from hypothesis import strategies as st

from engine.event import (
    Cause,
    Event,
    GoalFinished,
    GoalSent,
    MessageLogged,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    OperatorCommanded,
    RunEnded,
    RunStarted,
    StatusChanged,
    TransitionTaken,
)

PATHS = ("root", "root/a", "root/b", "root/b/x", "root/b/y", "root/b/y/deep", "root/c")
STEPS = st.lists(
    st.tuples(
        st.sampled_from(("enter", "exit", "fail", "divert", "status", "follow", "goal", "done", "log", "command")),
        st.sampled_from(PATHS),
        st.sampled_from((0.0, 0.5, 1.25)),
    ),
    max_size=120,
)


def made_up(steps: list[tuple[str, str, float]], *, ended: bool) -> list[Event]:
    """Return a run that begins, does that, and perhaps ends."""
    events: list[Event] = [
        RunStarted(seq=1, time_s=0.0, behavior="b", document="d", parameters={}, seed=1, clock="virtual")
    ]
    visits: dict[str, int] = {}
    time_s = 0.0
    for what, path, pause_s in steps:
        time_s += pause_s
        seq = len(events) + 1
        visit = visits.get(path, 1)
        match what:
            case "enter":
                visits[path] = visits.get(path, 0) + 1
                events.append(
                    NodeEntered(seq=seq, time_s=time_s, path=path, visit=visits[path], kind="state", inputs={})
                )
            case "exit":
                events.append(NodeExited(seq=seq, time_s=time_s, path=path, visit=visit, outcome="done"))
            case "fail":
                events.append(
                    NodeExited(seq=seq, time_s=time_s, path=path, visit=visit, outcome="", cause=Cause(message="lost"))
                )
            case "divert":
                events.append(NodeDiverted(seq=seq, time_s=time_s, path=path, visit=visit, by="timeout", target="c"))
            case "status":
                events.append(
                    StatusChanged(seq=seq, time_s=time_s, path=path, status=("running", "success")[int(pause_s)])
                )
            case "follow":
                events.append(
                    TransitionTaken(seq=seq, time_s=time_s, path=path, source="a", outcome="done", target="b")
                )
            case "goal":
                events.append(
                    GoalSent(seq=seq, time_s=time_s, path=path, goal="g", address="left/move_joints", request={})
                )
            case "done":
                events.append(
                    GoalFinished(seq=seq, time_s=time_s, path=path, goal="g", status="succeeded", result={"x": 1})
                )
            case "command":
                events.append(OperatorCommanded(seq=seq, time_s=time_s, command="pause", path="", arguments={}))
            case _:
                events.append(MessageLogged(seq=seq, time_s=time_s, path=path, level="info", message="said"))
    if ended:
        events.append(RunEnded(seq=len(events) + 1, time_s=time_s, status="finished", outcome="good"))
    return events
