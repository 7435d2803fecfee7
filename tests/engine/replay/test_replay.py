"""Replaying: the same run is the same, and of another one the first difference is named."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from engine.bus import SkillBus
from engine.clock import VirtualTimeDeadlock, run_virtual
from engine.document.faults import parse_faults
from engine.errors import DocumentError, RecordingError
from engine.event import (
    BehaviorChanged,
    FaultInjected,
    MessageLogged,
    MessageReceived,
    RunEnded,
    RunResumed,
    RunSteppedBack,
    ServiceCalled,
    UserdataWritten,
)
from engine.faults import FaultPort
from engine.recording import RecordedEvent, load_recording
from engine.replay import ReplayReport, replay
from engine.replay.replay_run import ReplayRun
from engine.runtime.history.hot_change import VersionSnapshot
from engine.runtime.plan import new_plan
from engine.runtime.record.skill_port import BusPort
from engine.state import Context, Outcome
from tests.engine.at_once import at_once
from tests.engine.replay.rig import CATALOGUE, Act, DoLook, Look, Range, behavior_of, record_run, recorded, replayed

TEXT = """
root:
  machine:
    initial: work
    states:
      work: {state: bench.Work, with: {for_s: 1}, transitions: {a: look, b: bad, c: bad}}
      look: {state: bench.Look, transitions: {a: listen, b: listen, c: bad}}
      listen: {state: bench.Listen, with: {messages: 1}, transitions: {a: good, b: good, c: good}}
"""


def changed(tmp_path: Path, *changes: tuple[str, str], text: str = TEXT) -> ReplayReport:
    """Record a document and replay it with a part of its text changed."""
    after = text
    for old, new in changes:
        assert old in after
        after = after.replace(old, new)
    recording = recorded(text, tmp_path / "r.mcap")
    return replay(recording, CATALOGUE, behavior=behavior_of(after))


def test_the_same_behavior_does_the_same(tmp_path: Path) -> None:
    report = replayed(TEXT, tmp_path / "r.mcap")
    assert (report.same, report.difference) == (True, None)
    assert report.compared == len(report.recording.events) == len(report.events)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (
            ("a: look, b: bad", "a: listen, b: bad"),
            "event 8 at 1.000 s, root: recorded `work —a→ look`; replayed `work —a→ listen` "
            '(target: "look" ≠ "listen")',
        ),
        (
            ("for_s: 1", "for_s: 2"),
            "event 3 at 0.000 s, root/work: recorded `entered`; replayed `entered` (inputs.for_s: 1 ≠ 2)",
        ),
        (
            ("state: bench.Look,", "state: bench.Look, with: {times: 2},"),
            "event 9 at 1.000 s, root/look: recorded `entered`; replayed `entered` (inputs.times: nothing ≠ 2)",
        ),
        (
            ("initial: work", "initial: look"),
            "event 3 at 0.000 s, root/work: recorded `entered`; replayed `entered` of root/look",
        ),
        (
            ("b: listen, c: bad", "b: bad, c: bad"),
            None,
        ),
    ],
    ids=["transition", "parameter", "added parameter", "another node", "what was not taken"],
)
def test_of_a_changed_behavior_the_first_difference_is_named(
    tmp_path: Path, change: tuple[str, str], line: str | None
) -> None:
    report = changed(tmp_path, change)
    assert (str(report.difference) if report.difference else None) == line


def test_the_events_before_the_difference_are_reported(tmp_path: Path) -> None:
    report = changed(tmp_path, ("a: look, b: bad", "a: listen, b: bad"))
    assert report.difference is not None
    assert report.difference.before[-2:] == (
        "6 1.000 s root/work worked_s = 1.0",
        "7 1.000 s root/work ended with a",
    )
    assert report.difference.explained().count("\n") == 8


TWICE = """
root: {machine: {initial: one, states: {one: {state: bench.Look, transitions: {a: good, b: good, c: bad}}}}}
"""


class Curious(DoLook, frozen=True, kw_only=True):
    """The same state to the engine; its code asks once more than when it was recorded."""

    async def run(self, ctx: Context) -> Outcome:
        await ctx.call(Look(), to="bench")
        return await DoLook.run(self, ctx)


def test_a_request_that_the_recording_does_not_know_is_the_difference(tmp_path: Path) -> None:
    recording = recorded(TWICE, tmp_path / "r.mcap")
    report = replay(recording, {**CATALOGUE, "bench.Look": Curious})
    assert str(report.difference) == (
        "event 6 at 0.000 s, root/one: recorded `seen = 1`; replayed `called bench/look: "
        '{"delay_s":0.0,"turns":0,"how":"done"}` '
        "(the recording does not contain this request)"
    )


def test_what_is_waited_for_in_vain_is_named(tmp_path: Path) -> None:
    recording = recorded(TEXT, tmp_path / "r.mcap")
    unheard = tuple(each for each in recording.events if not isinstance(each.event, MessageReceived))
    report = replay(replace(recording, events=unheard), CATALOGUE)
    assert "root/listen waits for a message of bench/tick, which the recording does not have" in str(report.difference)
    assert "replayed nothing" in str(report.difference)
    assert report.difference is not None
    assert report.difference.path == "root/listen"


def test_of_a_recording_that_was_cut_off_what_is_there_is_compared(tmp_path: Path) -> None:
    recording = recorded(TEXT, tmp_path / "r.mcap")
    for length in range(1, len(recording.events)):
        report = replay(replace(recording, events=recording.events[:length]), CATALOGUE)
        assert (report.same, report.compared) == (True, length)


def test_a_behavior_that_ends_earlier_misses_something(tmp_path: Path) -> None:
    report = changed(tmp_path, ("b: listen, c: bad", "b: good, c: bad"), ("a: listen, ", "a: good, "))
    assert "look —a→ listen" in str(report.difference)


def test_parameters_that_a_changed_behavior_does_not_take_are_an_error(tmp_path: Path) -> None:
    head = "flexcell: 1\nname: p\nparameters: {p: {type: number, default: 1}}\noutcomes: [good, bad]\n"
    recording = recorded(head + TEXT, tmp_path / "r.mcap")
    with pytest.raises(DocumentError, match="there is no parameter"):
        replay(recording, CATALOGUE, behavior=behavior_of(TEXT))


AT_ONCE = """
root:
  concurrency:
    states:
      looking: {foreach: {times: 2, next: [a, b, c], child: {state: bench.Look, with: {turns: TURNS}LOOKING}}}
      working: {foreach: {times: 2, next: [a, b, c], child: {state: bench.Work, with: {for_s: 0}WORKING}}}
    conditions: [{good: {looking: exhausted, working: exhausted}}]
"""
TIMEOUT = ", timeout: {after: 1, to: b}"


@pytest.mark.parametrize(("turns", "looking", "working"), [(1, TIMEOUT, TIMEOUT), (2, TIMEOUT, ""), (5, "", TIMEOUT)])
def test_the_order_of_answers_of_one_instant_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, turns: int, looking: str, working: str
) -> None:
    """All of it happens at time 0; how many turns of the loop each answer took there is not recorded."""
    text = AT_ONCE.replace("TURNS", str(turns)).replace("LOOKING", looking).replace("WORKING", working)
    recording = recorded(text, tmp_path / "r.mcap")
    assert replay(recording, CATALOGUE).difference is None
    monkeypatch.setattr("engine.replay.replayer.search_order", _first)
    assert replay(recording, CATALOGUE).difference is not None


def _first(first: ReplayRun, *_: object) -> ReplayRun:
    """Search for nothing."""
    return first


FAULTS = """
flexcell: 1
faults:
  - {at: root/work, late: 500 ms}
  - {at: root/look, error: it is dark}
  - {at: root/nowhere, hang: {}}
"""


def test_a_run_with_faults_replays_with_what_they_did(tmp_path: Path) -> None:
    faults = parse_faults(FAULTS, file="faults.yaml")

    def port(bus: SkillBus) -> FaultPort:
        return FaultPort(BusPort(bus), faults, clock=bus.clock)

    recording = recorded(TEXT, tmp_path / "r.mcap", skills=port)
    injected = [each.event for each in recording.events if isinstance(each.event, FaultInjected)]
    warned = [
        e.event for e in recording.events if isinstance(e.event, MessageLogged) and "never applied" in e.event.message
    ]
    assert (len(injected), len(warned)) == (2, 1)
    report = replay(recording, CATALOGUE)
    assert report.difference is None
    assert report.compared == len(recording.events) - 3


def test_a_run_in_which_nothing_could_happen_any_more_replays(tmp_path: Path) -> None:
    text = "root: {machine: {initial: w, states: {w: {state: test.Hang, transitions: {never: bad}}}}}"
    stuck = VirtualTimeDeadlock(
        "virtual time cannot advance at t=1.000 s: every task waits and no timer is set",
        where="root",
        hint="waiting: root/w",
    )
    acts: dict[float, Act] = {1.0: lambda run: run.fail(stuck)}
    recording = recorded(text, tmp_path / "r.mcap", acts=acts)
    assert getattr(recording.events[-1].event, "status", "") == "errored"
    assert replay(recording, CATALOGUE).difference is None


TREE = """
root:
  tree:
    selector:
      - {state: bench.Look, with: {how: fail}, on_error: failure}
      - sequence:
          - {state: bench.Work, with: {for_s: 0.5}}
          - retry: {times: 3, child: {state: bench.Work, with: {for_s: 0.25, how: fail}}}
  transitions: {success: good, failure: bad}
"""


def test_a_behavior_tree_replays(tmp_path: Path) -> None:
    text = "root:\n  machine:\n    initial: t\n    states:\n      t:\n" + "".join(
        f"      {line}\n" for line in TREE.strip().splitlines()[1:]
    )
    assert replayed(text, tmp_path / "r.mcap").difference is None


REAL = """
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left:
              machine:
                initial: look
                states:
                  look: {state: bench.Look, with: {times: 3}, transitions: {a: work, b: work, c: bad}}
                  work: {state: bench.Work, with: {for_s: 0.125}, transitions: {a: listen, b: bad, c: bad}}
                  listen: {state: bench.Listen, with: {messages: 1}, transitions: {a: out, b: out, c: out}}
            right:
              machine:
                initial: wait
                states:
                  wait: {state: test.Give, with: {after_s: 1.0}, transitions: {a: work, b: bad, c: bad}}
                  work:
                    state: bench.Work
                    with: {for_s: 5, rest_s: 0.05}
                    timeout: {after: 0.2, to: out}
                    transitions: {a: out, b: bad, c: bad}
          conditions: [{good: {left: out, right: out}}]
        transitions: {good: good}
"""


@pytest.mark.parametrize("distance_m", [float("inf"), float("nan")])
def test_a_number_that_json_does_not_have_is_replayed(tmp_path: Path, distance_m: float) -> None:
    """A sensor that sees nothing says so."""

    def publish(bus: SkillBus) -> None:
        bus.topic("range", Range).publish(Range(distance_m=distance_m))

    report = replayed(
        "root: {machine: {initial: far, states: {far: {state: bench.Far, transitions: {a: good, b: bad}}}}}",
        tmp_path / "r.mcap",
        prepare=publish,
    )
    assert (report.difference, report.same) == (None, True)
    told = [each.event.outcome for each in report.recording.events if isinstance(each.event, RunEnded)]
    assert told == ["bad" if distance_m == float("inf") else "good"]


REACTIVE = """
root:
  machine:
    initial: tree
    states:
      tree:
        tree:
          sequence:
            memory: false
            children:
              - {state: bench.Glance, with: {until: 4}, every: PERIOD}
              - {state: bench.Work, name: carry, with: {for_s: 60}}
        transitions: {success: good, failure: bad}
"""


def test_a_check_that_was_observed_turns_at_the_same_moment_again(tmp_path: Path) -> None:
    """Of the observations that changed nothing there is no event; the camera has looked four times."""
    report = replayed(REACTIVE.replace("PERIOD", "500 ms"), tmp_path / "r.mcap")
    assert (report.difference, report.same) == (None, True)
    asked = [each for each in report.recording.events if isinstance(each.event, ServiceCalled)]
    assert [each.at_s for each in asked] == [0.0, 1.5]


async def test_it_does_where_that_was_in_real_time(tmp_path: Path) -> None:
    """When the check was asked again is known only from its being entered."""
    result, _ = await record_run(REACTIVE.replace("PERIOD", "20 ms"), tmp_path / "r.mcap")
    report = await asyncio.to_thread(replay, load_recording(tmp_path / "r.mcap"), CATALOGUE)
    assert (result.outcome, report.difference, report.same) == ("bad", None, True)


def test_a_fault_of_an_observation_is_met(tmp_path: Path) -> None:
    """The third question to the camera is the first that fails; the tick is answered with what was observed."""
    faults = parse_faults("flexcell: 1\nfaults: [{address: bench/look, request: 3, error: too dark}]\n", file="f.yaml")
    path = tmp_path / "r.mcap"
    text = REACTIVE.replace("PERIOD", "500 ms")
    result, _ = run_virtual(record_run(text, path, skills=lambda bus: FaultPort(BusPort(bus), faults, clock=bus.clock)))
    assert (result.status, result.duration_s) == ("errored", 1.0)
    report = replay(load_recording(path), CATALOGUE)
    assert (report.difference, report.same) == (None, True)


async def test_a_run_in_real_time_replays_by_branch(tmp_path: Path) -> None:
    """Its times are chance, and so is the order of its branches; what each branch does is not."""
    result, _ = await record_run(REAL, tmp_path / "r.mcap", rate_hz=50)
    assert result.outcome == "good"
    recording = load_recording(tmp_path / "r.mcap")
    assert recording.description.clock == "real"
    report = await asyncio.to_thread(replay, recording, CATALOGUE)
    assert report.difference is None, report.difference
    left = [each for each in recording.events if "/left" in getattr(each.event, "path", "")]
    others = [each for each in recording.events if each not in left]
    shuffled = replace(recording, events=(others[0], *left, *others[1:]))
    assert (await asyncio.to_thread(replay, shuffled, CATALOGUE)).same


async def test_of_a_run_in_real_time_the_branch_that_differs_is_named(tmp_path: Path) -> None:
    await record_run(REAL, tmp_path / "r.mcap")
    recording = load_recording(tmp_path / "r.mcap")
    other = behavior_of(REAL.replace("a: listen, b: bad", "a: look, b: bad"))
    report = await asyncio.to_thread(replay, recording, CATALOGUE, behavior=other)
    assert report.difference is not None
    assert report.difference.path == "root/both/left"
    assert report.difference.recorded == "`work —a→ listen`"
    assert report.difference.replayed == "`work —a→ look`"


def test_a_run_that_was_resumed_is_refused(tmp_path: Path) -> None:
    recording = recorded(TEXT, tmp_path / "r.mcap")
    resumed = RunResumed(seq=4, time_s=0.0, after_seq=3, epoch=2, rerun=())
    with pytest.raises(RecordingError, match=r"was not executed from its start \(event 4\), which cannot be replayed"):
        replay(replace(recording, events=(*recording.events[:3], RecordedEvent(resumed, 0.0))), CATALOGUE)


def test_a_recording_without_events_or_without_its_start_is_refused(tmp_path: Path) -> None:
    recording = recorded(TEXT, tmp_path / "r.mcap")
    with pytest.raises(RecordingError, match="this recording contains no events"):
        replay(replace(recording, events=()), CATALOGUE)
    with pytest.raises(RecordingError, match="does not begin with the start of its run"):
        replay(replace(recording, events=recording.events[1:]), CATALOGUE)


def test_a_run_that_was_stepped_back_does_it_again_with_what_its_undoing_asked_for(tmp_path: Path) -> None:
    acts: dict[float, Act] = {
        1.125: lambda run: run.control.pause(),
        2.0: lambda run: at_once(run.step_back()),
        3.0: lambda run: at_once(run.step_back()),
        4.0: lambda run: at_once(run.step_back()),
        4.25: lambda run: run.control.pause(),
        4.75: lambda run: run.control.resume(),
        9.0: lambda run: run.control.resume(),
    }
    text = TEXT.replace("look: {state: bench.Look,", "look: {state: bench.Glance, with: {until: 9},")
    text = text.replace("listen, c: bad}}\n      listen", "listen}}\n      listen")
    text = text.replace("listen: {state: bench.Listen, with: {messages: 1}", "listen: {state: bench.Work").replace(
        "{a: good, b: good, c: good}", "{a: good, b: bad, c: bad}"
    )
    recording = recorded(text, tmp_path / "r.mcap", acts=acts)
    assert [each.event.path for each in recording.events if isinstance(each.event, RunSteppedBack)] == [
        "root/listen",
        "root/look",
        "root/work",
    ]
    report = replay(recording, CATALOGUE)
    assert report.difference is None, report.difference.explained()
    assert report.compared == len(recording.events)


def test_a_run_whose_behavior_was_changed_is_replayed_with_both_versions(tmp_path: Path) -> None:
    new = behavior_of(TEXT.replace("for_s: 1", "for_s: 2"))
    kept = VersionSnapshot(behavior="test.yaml", documents={"test.yaml": msgspec.json.encode(new.document).decode()})
    acts: dict[float, Act] = {
        0.5: lambda run: run.control.pause(),
        1.0: lambda run: run.change(new_plan(new, CATALOGUE), preempt=True, kept=kept),
        2.0: lambda run: run.control.resume(),
    }
    recording = recorded(TEXT, tmp_path / "r.mcap", acts=acts)
    (change,) = [each.event for each in recording.events if isinstance(each.event, BehaviorChanged)]
    assert change.restarted == ("root/work",)
    report = replay(recording, CATALOGUE)
    assert report.difference is None, report.difference.explained()
    assert report.compared == len(recording.events)
    with pytest.raises(RecordingError, match="with its own versions only"):
        replay(recording, CATALOGUE, behavior=new)


def test_a_change_whose_version_was_not_kept_cannot_be_replayed(tmp_path: Path) -> None:
    new = new_plan(behavior_of(TEXT.replace("for_s: 1", "for_s: 2")), CATALOGUE)
    acts: dict[float, Act] = {
        0.5: lambda run: run.control.pause(),
        1.0: lambda run: run.change(new),
        2.0: lambda run: run.control.resume(),
    }
    with pytest.raises(RecordingError, match="the new version was not kept"):
        replay(recorded(TEXT, tmp_path / "r.mcap", acts=acts), CATALOGUE)


def test_a_value_that_a_person_set_is_set_again(tmp_path: Path) -> None:
    acts: dict[float, Act] = {
        0.5: lambda run: run.control.pause(),
        0.75: lambda run: run.control.set_userdata("", "n", {"to": [1.5, None]}),
        2.0: lambda run: run.control.resume(),
    }
    recording = recorded("userdata: {n: 1}" + TEXT, tmp_path / "r.mcap", acts=acts)
    report = replay(recording, CATALOGUE)
    assert report.difference is None, report.difference.explained()
    written = [each for each in report.events if isinstance(each, UserdataWritten) and each.key == "n"]
    assert [(each.path, each.key, each.value) for each in written] == [("", "n", {"to": [1.5, None]})]
