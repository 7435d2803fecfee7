"""States for the bus in runs on a real bus: what is waited for, published, called and sent by name; and replayed."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import dedent

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.bus import ActiveGoal, SkillBus
from engine.cell.cell_topics import open_topics
from engine.clock import new_clock, run_virtual
from engine.document import load_cell, parse_behavior
from engine.document.cell import CellDocument
from engine.document.parameter_spec import ParameterSpec
from engine.errors import BusError, DocumentError, GoalRejected
from engine.event import Event, GoalFinished, GoalSent, MessagePublished, MessageReceived, NodeExited, ServiceAnswered
from engine.journal import MemoryRunJournal
from engine.messages import GripperState
from engine.messages.topic_value import TopicValue
from engine.recording import RecordedDocuments, RecordingOptions, RunRecording, load_recording
from engine.registry import load_states
from engine.replay import replay
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from engine.skills.digital_outputs import SetOutput
from engine.skills.gripper import GraspResult, GripperFeedback, GripperMove, ReadGripper
from engine.skills.switch_result import SwitchResult
from states.bus.message_condition import compile_condition
from states.bus.wait_for_message import WaitForMessage

HEAD = "flexcell: 1\nname: test\noutcomes: [good, bad]\nsuccess: [good]\n"
DOCUMENT = CellDocument(
    flexcell=1,
    cell="bench",
    topics={
        "operator/key": ParameterSpec(type="string"),
        "line/rate": ParameterSpec(type="number", minimum=0.0, maximum=2.0, default=1.0),
    },
)
OPEN = GripperState(time_s=0.0, width_m=0.08, force_n=0.0, held=False)


@dataclass
class DeviceBus:
    """A gripper at `left/gripper`, outputs at `left`, and the topics of a cell."""

    bus: SkillBus
    moved: list[GripperMove] = field(default_factory=list[GripperMove])

    def __post_init__(self) -> None:
        open_topics(self.bus, DOCUMENT)
        self.bus.advertise_action(GripperMove, self.move, namespace="left/gripper")
        self.bus.advertise_service(ReadGripper, self.read, namespace="left/gripper")
        self.bus.advertise_service(SetOutput, self.switch, namespace="left")

    async def move(self, goal: GripperMove, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        if goal.width_m > 0.08:
            raise GoalRejected("wider than it opens", where="left/gripper")
        handle.accept()
        self.moved.append(goal)
        await self.bus.clock.sleep(1.0)
        return GraspResult(held=False, width_m=goal.width_m, force_n=0.0)

    def read(self, request: ReadGripper) -> GripperState:
        return OPEN

    def switch(self, request: SetOutput) -> SwitchResult:
        return SwitchResult(success=request.output == 3, message="" if request.output == 3 else "no such relay")

    def key(self, value: str) -> None:
        self.bus.topic("operator/key", TopicValue).publish(TopicValue(value=value))


@dataclass(frozen=True)
class Ran:
    """A run that has ended."""

    result: RunResult
    events: tuple[Event, ...]
    bench: DeviceBus
    ended_s: float

    @property
    def left(self) -> list[str]:
        return [f"{e.path} {e.outcome or 'preempted'}" for e in self.events if isinstance(e, NodeExited)]

    def of(self, kind: type[Event]) -> list[Event]:
        return [event for event in self.events if isinstance(event, kind)]


def causes(result: RunResult) -> str:
    """The cause chain as one text."""
    return "; ".join(link.message for link in result.cause.chain()) if result.cause is not None else ""


def ran(text: str, *presses: tuple[float, str]) -> Ran:
    """Run a document beside an operator who presses keys at times in seconds."""
    plan = new_plan(parse_behavior(HEAD + dedent(text), file="test.yaml"), load_states())
    events: list[Event] = []

    async def main() -> Ran:
        async with SkillBus(new_clock()) as bus:
            bench = DeviceBus(bus)
            for at_s, key in presses:
                asyncio.get_running_loop().call_later(at_s, bench.key, key)
            run = Run(plan, run="r", bus=bus)
            run.watch(events.append)
            result = await run.execute()
            return Ran(result, tuple(events), bench, bus.clock.now_s())

    return run_virtual(main())


def waiting(*options: str) -> str:
    return f"""
        root:
          machine:
            initial: wait
            states:
              wait:
                state: bus.WaitForMessage
                with: {{{", ".join(("topic: operator/key", *options))}}}
                out: {{message: pressed}}
                transitions: {{received: good, timeout: bad}}
        """


def test_the_message_that_meets_the_condition_ends_the_wait_and_it_alone_is_recorded() -> None:
    run = ran(waiting("condition: \"message.value == 's'\""), (0.5, "a"), (1.0, "b"), (1.5, "s"), (2.0, "s"))
    assert (run.result.outcome, run.ended_s) == ("good", 1.5)
    (received,) = run.of(MessageReceived)
    assert isinstance(received, MessageReceived)
    assert (received.topic, received.message) == ("operator/key", {"value": "s"})


def test_none_of_many_messages_of_one_instant_is_missed() -> None:
    run = ran(waiting("condition: \"message.value == 's'\""), *((1.0, key) for key in "abcs"))
    assert run.result.outcome == "good"


def test_a_wait_ends_at_its_timeout_and_says_for_what_it_waited() -> None:
    run = ran(waiting("condition: \"message.value == 's'\"", "timeout_s: 2.0"), (1.0, "a"))
    assert (run.result.outcome, run.ended_s) == ("bad", 2.0)
    assert run.result.cause is not None
    assert "operator/key had no message with message.value == 's' within 2 s" in causes(run.result)


@given(st.integers(100, 3000), st.integers(100, 3000))
def test_what_comes_first_ends_the_wait(pressed_ms: int, timeout_ms: int) -> None:
    """In milliseconds: times that are nearer than the clock can tell apart are one instant."""
    pressed_s, timeout_s = pressed_ms / 1000, timeout_ms / 1000
    run = ran(waiting(f"timeout_s: {timeout_s}"), (pressed_s, "s"))
    if pressed_s != timeout_s:
        assert run.result.outcome == ("good" if pressed_s < timeout_s else "bad")
        assert run.ended_s == pytest.approx(min(pressed_s, timeout_s))


def test_a_message_from_before_counts_only_where_that_is_wanted() -> None:
    late = """
        root:
          machine:
            initial: pause
            states:
              pause: {{state: flow.Wait, with: {{duration_s: 1.0}}, transitions: {{done: wait}}}}
              wait:
                state: bus.WaitForMessage
                with: {{topic: operator/key, timeout_s: 1.0, accept_latest: {accept}}}
                transitions: {{received: good, timeout: bad}}
        """
    assert ran(late.format(accept="false"), (0.5, "s")).result.outcome == "bad"
    assert ran(late.format(accept="true"), (0.5, "s")).result.outcome == "good"


def test_a_wait_in_a_branch_ends_the_work_beside_it() -> None:
    run = ran(
        """
        root:
          machine:
            initial: both
            states:
              both:
                concurrency:
                  states:
                    work:
                      state: bus.SendGoal
                      with: {action: left/gripper/gripper_move, goal: {width_m: 0.04, speed_m_s: 0.1}}
                    key: {state: bus.WaitForMessage, with: {topic: operator/key}}
                  conditions:
                    - {good: {key: received}}
                    - {bad: {work: succeeded}}
                    - {bad: {work: failed}}
                transitions: {good: good, bad: bad}
        """,
        (0.25, "x"),
    )
    assert run.result.outcome == "good", run.result
    assert run.ended_s < 1.0


def test_a_condition_that_is_neither_true_nor_false_fails_the_state() -> None:
    run = ran(waiting("condition: message.value"), (1.0, "s"))
    assert run.result.status == "errored"
    assert "neither true nor false" in causes(run.result)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("message.value ==", "is no expression"),
        ("key == 's'", "reads `key`, but only `message`"),
        ("1 +", "expression"),
    ],
)
def test_a_condition_that_can_never_be_evaluated_is_refused_with_the_document(text: str, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        WaitForMessage(topic="operator/key", condition=text)


@given(st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=12))
def test_a_condition_says_what_python_says(value: str) -> None:
    met = compile_condition("size(message.value) > 3 && message.value != 'abcd'")
    assert met({"value": value}) == (len(value) > 3 and value != "abcd")


def test_a_topic_that_does_not_exist_fails_the_wait_at_once() -> None:
    run = ran(waiting().replace("operator/key", "operator/kei"), (0.5, "s"))
    assert run.ended_s == 0.0
    assert "no such topic" in causes(run.result)


def publishing(topic: str, value: str) -> str:
    return f"""
        root:
          machine:
            initial: tell
            states:
              tell:
                state: bus.Publish
                with: {{topic: {topic}, value: {value}}}
                transitions: {{published: good}}
        """


def test_a_value_is_published_and_recorded() -> None:
    run = ran(publishing("line/rate", "0.5"))
    assert run.result.outcome == "good"
    assert run.bench.bus.topic("line/rate", TopicValue).latest == TopicValue(value=0.5)
    (published,) = run.of(MessagePublished)
    assert isinstance(published, MessagePublished)
    assert (published.topic, published.message) == ("line/rate", 0.5)


@pytest.mark.parametrize(("value", "says"), [("5.0", "above the maximum 2"), ("fast", "is not a number")])
def test_a_value_that_does_not_fit_the_topic_is_refused(value: str, says: str) -> None:
    run = ran(publishing("line/rate", value))
    assert run.result.outcome is None
    assert says in causes(run.result)
    assert run.bench.bus.topic("line/rate", TopicValue).latest == TopicValue(value=1.0)


def test_the_command_topics_of_devices_are_not_for_behaviors() -> None:
    async def main() -> None:
        async with SkillBus(new_clock()) as bus:
            bench = DeviceBus(bus)
            taken: list[GripperState] = []
            bus.topic("left/jog", GripperState).subscribe_commands(taken.append)
            plan = new_plan(parse_behavior(HEAD + dedent(publishing("left/jog", "{}")), file="t.yaml"), load_states())
            result = await Run(plan, run="r", bus=bench.bus).execute()
            assert "a behavior cannot publish on a topic of GripperState" in causes(result)
            assert taken == []

    run_virtual(main())


def calling(service: str, request: str) -> str:
    return f"""
        root:
          machine:
            initial: ask
            states:
              ask:
                state: bus.CallService
                with: {{service: {service}, request: {request}}}
                out: {{answer: answer}}
                transitions: {{answered: good, failed: bad}}
        """


def test_a_service_is_called_by_its_address_and_its_answer_is_plain_data() -> None:
    run = ran(calling("left/gripper/read_gripper", "{}"))
    assert run.result.outcome == "good"
    (answered,) = run.of(ServiceAnswered)
    assert isinstance(answered, ServiceAnswered)
    assert answered.result == {"time_s": 0.0, "width_m": 0.08, "force_n": 0.0, "held": False}


def test_a_refused_switch_is_the_outcome_failed_with_its_reason() -> None:
    assert ran(calling("left/set_output", "{output: 3, value: true}")).result.outcome == "good"
    run = ran(calling("left/set_output", "{output: 4, value: true}"))
    assert run.result.outcome == "bad"
    assert "no such relay" in causes(run.result)


@pytest.mark.parametrize(
    ("service", "request_", "says"),
    [
        ("left/gripper/read_griper", "{}", "no such service"),
        ("left/set_output", "{output: three, value: true}", "this is not a SetOutput"),
        ("left/gripper/gripper_move", "{width_m: 0.04, speed_m_s: 0.1}", "this is an action, not a service"),
    ],
)
def test_a_call_that_cannot_be_made_says_why(service: str, request_: str, says: str) -> None:
    run = ran(calling(service, request_))
    assert run.result.outcome is None
    assert says in causes(run.result)
    assert run.bench.moved == []


def sending(action: str, goal: str) -> str:
    return f"""
        root:
          machine:
            initial: go
            states:
              go:
                state: bus.SendGoal
                with: {{action: {action}, goal: {goal}}}
                out: {{result: result}}
                transitions: {{succeeded: good, failed: bad}}
        """


def test_a_goal_is_sent_by_its_address_and_recorded_as_it_was_given() -> None:
    run = ran(sending("left/gripper/gripper_move", "{width_m: 0.04, speed_m_s: 0.1}"))
    assert run.result.outcome == "good"
    assert run.bench.moved == [GripperMove(width_m=0.04, speed_m_s=0.1)]
    (sent,), (finished,) = run.of(GoalSent), run.of(GoalFinished)
    assert isinstance(sent, GoalSent)
    assert isinstance(finished, GoalFinished)
    assert (sent.address, sent.request) == ("left/gripper/gripper_move", {"width_m": 0.04, "speed_m_s": 0.1})
    assert finished.result == {"held": False, "width_m": 0.04, "force_n": 0.0, "reason": ""}


def test_a_rejected_goal_is_the_outcome_failed_with_its_reason() -> None:
    run = ran(sending("left/gripper/gripper_move", "{width_m: 0.5, speed_m_s: 0.1}"))
    assert run.result.outcome == "bad"
    assert "wider than it opens" in causes(run.result)
    assert run.bench.moved == []


def test_a_tree_turns_to_another_branch_when_the_topic_changes() -> None:
    run = ran(
        """
        root:
          machine:
            initial: tree
            states:
              tree:
                tree:
                  selector:
                    memory: false
                    children:
                      - sequence:
                          memory: false
                          children:
                            - state: bus.CheckMessage
                              name: pressed
                              with: {topic: operator/key, condition: "message.value == 'q'"}
                            - {state: flow.Wait, name: rest, with: {duration_s: 1.0}}
                      - {state: flow.Wait, name: work, with: {duration_s: 60.0}}
                transitions: {success: good, failure: bad}
        """,
        (0.0, "a"),
        (2.0, "b"),
        (5.0, "q"),
    )
    assert (run.result.outcome, run.ended_s) == ("good", 6.0)


def test_a_recording_is_replayed_without_the_bus(tmp_path: Path) -> None:
    text = """
        root:
          machine:
            initial: wait
            states:
              wait:
                state: bus.WaitForMessage
                with: {topic: operator/key, condition: "message.value == 's'", timeout_s: 5.0}
                transitions: {received: tell, timeout: bad}
              tell:
                state: bus.Publish
                with: {topic: line/rate, value: 0.5}
                transitions: {published: ask}
              ask:
                state: bus.CallService
                with: {service: left/gripper/read_gripper}
                transitions: {answered: go, failed: bad}
              go:
                state: bus.SendGoal
                with: {action: left/gripper/gripper_move, goal: {width_m: 0.04, speed_m_s: 0.1}}
                transitions: {succeeded: again, failed: bad}
              again:
                state: bus.WaitForMessage
                with: {topic: operator/key, timeout_s: 1.0}
                transitions: {received: bad, timeout: good}
        """
    behavior = parse_behavior(HEAD + dedent(text), file="test.yaml")
    path = tmp_path / "run.mcap"

    async def record() -> RunResult:
        texts = {"test.yaml": msgspec.json.encode(behavior.document)}
        options = RecordingOptions(path=path, documents=RecordedDocuments(behavior="test.yaml", texts=texts))
        async with SkillBus(new_clock()) as bus, RunRecording.open(options, inline=True) as recording:
            bench = DeviceBus(bus)
            for at_s, key in ((0.5, "a"), (1.0, "s")):
                asyncio.get_running_loop().call_later(at_s, bench.key, key)
            run = Run(new_plan(behavior, load_states()), run="r", bus=bus, journal=MemoryRunJournal(run_id="r"))
            recording.attach(run, bus, started_unix_s=1.0)
            return await run.execute()

    assert run_virtual(record()).outcome == "good"
    report = replay(load_recording(path), load_states())
    assert report.same, report


def test_a_cell_refuses_topics_below_its_devices_and_defaults_that_do_not_fit(
    tmp_path: Path,
) -> None:
    head = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nrobots: {arm: {model: servo_arm}}\n"
    cases: dict[str, str] = {
        "topics: {arm/key: {type: string}}": "the topics below `arm` are those of robot `arm`",
        "topics: {store/key: {type: string}}": "those of flexcell",
        "topics: {line/rate: {type: number, default: fast}}": "the default of topic `line/rate`: 'fast' is",
        "topics: {key: {type: string}}": "key",
    }
    for number, (text, says) in enumerate(cases.items()):
        file = tmp_path / f"{number}.yaml"
        file.write_text(head + text, encoding="utf-8")
        with pytest.raises(DocumentError, match=says):
            load_cell(file)


async def test_everybody_may_publish_what_fits_on_a_topic_of_the_cell() -> None:
    async with SkillBus(new_clock()) as bus:
        open_topics(bus, DOCUMENT)
        assert bus.command_topics() == ("line/rate", "operator/key")
        with pytest.raises(BusError, match=r"operator/key: the value does not fit the topic: 3 is not text"):
            bus.topic("operator/key", TopicValue).publish(TopicValue(value=3))
        assert bus.find_topic("line/rate").latest == TopicValue(value=1.0)
