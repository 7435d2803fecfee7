"""Runs made up of events as an engine could tell them: nodes entered, left, diverted, commanded, in any order."""

from __future__ import annotations

from hypothesis import strategies as st

from engine.errors import Cause
from engine.event import (
    BehaviorChanged,
    BranchesPreempted,
    Event,
    GatePassed,
    GoalFinished,
    GoalSent,
    MessageLogged,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    NodeRetried,
    OperatorCommanded,
    RunEnded,
    RunResumed,
    RunStarted,
    RunSteppedBack,
    StatusChanged,
    TransitionTaken,
    UndoEnded,
    UndoStarted,
)

PATHS = ("root", "root/a", "root/b", "root/b/x", "root/b/y", "root/b/y/deep", "root/c")
FOLLOWED = {"root": ("a", "b"), "root/b": ("x", "y"), "root/b/y": ("deep", "good")}
"""The child that a container proceeds from, and the sibling or outcome that it proceeds to."""
RARE = ("retry", "lock", "preempt", "undo", "undone", "back", "change", "gate", "resume")
STEPS = st.lists(
    st.tuples(
        st.sampled_from(
            ("enter", "exit", "fail", "divert", "status", "follow", "goal", "done", "log", "command", *RARE)
        ),
        st.sampled_from(PATHS),
        st.sampled_from((0.0, 0.5, 1.25)),
    ),
    max_size=120,
)


def made_up(steps: list[tuple[str, str, float]], *, ended: bool) -> list[Event]:
    """Return a run that begins, does that, and perhaps ends.

    Only what was entered is left or preempted, and not what was inside a node that has been tried again since.
    """
    events: list[Event] = [
        RunStarted(seq=1, time_s=0.0, behavior="b", document="d", parameters={}, seed=1, clock="virtual")
    ]
    visits: dict[str, int] = {}
    there: set[str] = set()
    time_s = 0.0
    for what, path, pause_s in steps:
        time_s += pause_s
        seq = len(events) + 1
        visit = visits.get(path, 1)
        left = path if what != "preempt" else f"root/{path[5:] or 'a'}"
        match what:
            case "exit" | "fail" | "preempt" if left not in there:
                continue
            case "enter":
                visits[path] = visits.get(path, 0) + 1
                there.add(path)
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
                source, target = FOLLOWED.get(path, ("a", "good"))
                events.append(
                    TransitionTaken(seq=seq, time_s=time_s, path=path, source=source, outcome="done", target=target)
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
            case "retry":
                there = {each for each in there if not each.startswith(f"{path}/")}
                events.append(NodeRetried(seq=seq, time_s=time_s, path=path, attempt=2, wait_s=0.5))
            case "lock":
                events.append(OperatorCommanded(seq=seq, time_s=time_s, command="lock", path=path, arguments={}))
            case "preempt":
                events.append(
                    BranchesPreempted(seq=seq, time_s=time_s, path="root", condition="x", branches=(path[5:] or "a",))
                )
            case "undo":
                events.append(UndoStarted(seq=seq, time_s=time_s, path=path, visit=visit + 1, undoes=visit))
            case "undone":
                events.append(UndoEnded(seq=seq, time_s=time_s, path=path, visit=visit + 1, undoes=visit))
            case "back":
                events.append(RunSteppedBack(seq=seq, time_s=time_s, path=path, source="root/b"))
            case "change":
                events.append(
                    BehaviorChanged(seq=seq, time_s=time_s, document="e", report=(), removed=(path,) if pause_s else ())
                )
            case "gate":
                events.append(GatePassed(seq=seq, time_s=time_s, path=path, visit=visit, point="after"))
            case "resume":
                after_seq = max(1, seq - 1 - int(pause_s * 8))
                events.append(RunResumed(seq=seq, time_s=time_s, after_seq=after_seq, epoch=2, rerun=()))
            case _:
                events.append(MessageLogged(seq=seq, time_s=time_s, path=path, level="info", message="said"))
    if ended:
        events.append(RunEnded(seq=len(events) + 1, time_s=time_s, status="finished", outcome="good"))
    return events
