"""How long a run of 100,000 events takes to open for looking at it, and each further moment of it.

    python -m benchmarks.past_run_opening

It is made up of 300 states below ten machines that are passed again and again, each with a goal and a write, and is
read from a journal on the disk, as after a restart of the server. Processor times come along, for busy machines.
"""

from __future__ import annotations

import random
import statistics
import tempfile
import time
from pathlib import Path

import msgspec

from editor_web.past.timeline import RunHistory
from engine.archive import Archive
from engine.event import Event, GoalFinished, GoalSent, NodeEntered, NodeExited, RunEnded, RunStarted, TransitionTaken
from engine.event import UserdataWritten as Written
from engine.journal import Journal

EVENTS = 100_000
STATES = 300
POSITIONS = 100


def made_up_run(count: int = EVENTS, *, states: int = STATES) -> list[Event]:
    """Return a run of that many events, six for each visit of a state."""
    events: list[Event] = [
        RunStarted(seq=1, time_s=0.0, behavior="long", document="d", parameters={}, seed=1, clock="real"),
        NodeEntered(seq=2, time_s=0.0, path="root", visit=1, kind="machine", inputs={}),
    ]
    turn = 0
    while len(events) < count - 7:
        path, visit, goal = f"root/m{turn % 10}/s{turn % states}", turn // states + 1, f"g{turn}"
        begun_s, seq, turn = turn * 0.06, len(events), turn + 1
        events += [
            NodeEntered(seq=seq + 1, time_s=begun_s, path=path, visit=visit, kind="state", inputs={}),
            GoalSent(seq=seq + 2, time_s=begun_s, path=path, goal=goal, address="left/move", request={"q": [0.1] * 7}),
            GoalFinished(seq=seq + 3, time_s=begun_s + 0.05, path=path, goal=goal, status="succeeded", result={"s": 1}),
            Written(seq=seq + 4, time_s=begun_s + 0.05, path=path, scope="root", key="turn", value=turn),
            NodeExited(seq=seq + 5, time_s=begun_s + 0.05, path=path, visit=visit, outcome="done"),
            TransitionTaken(seq=seq + 6, time_s=begun_s + 0.05, path="root", source="a", outcome="done", target="b"),
        ]
    last_s = turn * 0.06
    events.append(NodeExited(seq=len(events) + 1, time_s=last_s, path="root", visit=1, outcome="done"))
    events.append(RunEnded(seq=len(events) + 1, time_s=last_s, status="finished", outcome="done"))
    return events


def journaled(folder: Path, events: list[Event]) -> str:
    """Write a run into a journal and return its name."""
    with Journal.open(folder, inline=True) as journal:
        run = journal.begin("long", behavior="long", document="d", started_unix_s=time.time())
        for event in events:
            run.append(event)
    return "long"


def main() -> None:
    """Measure and print."""
    events = made_up_run()
    with tempfile.TemporaryDirectory() as folder:
        run = journaled(Path(folder), events)
        archive = Archive(Path(folder), {}, Path(folder))
        begin, begin_cpu = time.perf_counter(), time.process_time()
        opened = archive.run(run)
        read_s = time.perf_counter() - begin
        course = RunHistory(run)
        for event in opened.events:
            course.follow(event)
        first = msgspec.json.encode(course.states.at(EVENTS // 2))
        open_s, open_cpu_s = time.perf_counter() - begin, time.process_time() - begin_cpu
    begin = time.perf_counter()
    timeline = msgspec.json.encode(course.timeline())
    timeline_s = time.perf_counter() - begin
    draw = random.Random(1)
    taken_s: list[float] = []
    taken_cpu_s: list[float] = []
    for _ in range(POSITIONS):
        position = draw.randrange(1, len(events))
        begin, begin_cpu = time.perf_counter(), time.process_time()
        msgspec.json.encode(course.states.at(position))
        taken_s.append(time.perf_counter() - begin)
        taken_cpu_s.append(time.process_time() - begin_cpu)
    print(f"{len(events)} events: read {read_s:.3f} s, read and first moment {open_s:.3f} s (CPU {open_cpu_s:.3f} s)")
    print(f"timeline {timeline_s * 1e3:.0f} ms, {len(timeline) / 1e6:.2f} MB; a moment {len(first) / 1e3:.0f} kB")
    for what, each_s in (("", taken_s), (" (CPU)", taken_cpu_s)):
        print(
            f"further moments{what}: median {statistics.median(each_s) * 1e3:.1f} ms, worst {max(each_s) * 1e3:.1f} ms"
        )


if __name__ == "__main__":
    main()
