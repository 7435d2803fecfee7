"""The Helping Hand: handles triggers, captures robot states, starts hand guiding, saves captures (RCY 7.1)."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from engine.bus import GoalHandle, SkillBus
from engine.cause_chain import cause_of, describe_cause
from engine.errors import BusError, DocumentError, FlexcellError, SkillFailed
from engine.skills.entries import EntryRecord
from engine.skills.guiding import FinishGuiding, GuideArm
from engine.skills.proposing import Proposal, ProposeBehavior
from engine.skills.teaching import (
    ButtonState,
    Capture,
    DiscardCapture,
    FireTrigger,
    ReadCapture,
    ReadTeachStatus,
    SaveCapture,
    SetTriggers,
    TeachNow,
    TeachStatus,
    Trigger,
    TriggerStatus,
)
from engine.skills.trigger_document import ReadTriggerDocument, TriggerDocument, WriteTriggerDocument
from engine.teaching.capture_buffer import CaptureBuffer
from engine.teaching.capture_builder import CaptureBuilder
from engine.teaching.capture_saving import save_capture
from engine.teaching.edge_detection import ButtonEdge, EdgeDetector
from engine.teaching.joint_recording import JointRecording
from engine.teaching.proposal_service import propose
from engine.teaching.trigger_file import TriggerFile

NAMESPACE = "teach"
STATUS = f"{NAMESPACE}/status"
_RECORDS = ("joint_dmp_save", "cart_dmp_save")
_BY_HAND = "by hand"
_log = logging.getLogger("flexcell.teaching")


def guidable_robots(bus: SkillBus) -> tuple[str, ...]:
    """Return the robots on a bus that support hand guiding, sorted."""
    ending = f"/{GuideArm.skill_name()}"
    return tuple(sorted(row.name.removesuffix(ending) for row in bus.listing() if row.name.endswith(ending)))


@dataclass(kw_only=True)
class _TriggerSubscription:
    """One trigger and its subscription."""

    trigger: Trigger
    message_type: str = ""
    detector: EdgeDetector | None = None
    fault: str = ""
    close: Callable[[], None] = lambda: None


class HelpingHand:
    """Serves `teach/…` while it is open; belongs to the event loop of its bus.

    Trigger actions are executed one after the other, in the order in which the buttons were pressed;
    recordings start and end immediately. A rejected action is reported in the status and changes nothing.

    Args:
        bus: The bus with the robots and the store.
        robots: The arms that can be taught, by their names on the bus.
        folder: Folder of captures that are not yet saved or discarded; None keeps them in memory.
        triggers: Initial triggers, if `file` has none.
        file: File of the triggers; None keeps them in memory.
    """

    def __init__(
        self,
        bus: SkillBus,
        *,
        robots: Sequence[str],
        folder: Path | None = None,
        triggers: Sequence[Trigger] = (),
        file: Path | None = None,
    ) -> None:
        self._bus = bus
        self._robots = tuple(robots)
        self._buffer = CaptureBuffer(folder)
        self._capturing = CaptureBuilder(bus, self._buffer)
        self._file = TriggerFile(file, triggers)
        self._listening: list[_TriggerSubscription] = []
        self._recordings: dict[str, tuple[Trigger, JointRecording]] = {}
        self._guides: dict[str, GoalHandle[Any, Any]] = {}
        self._due: asyncio.Queue[tuple[Trigger, Callable[[], Any]]] = asyncio.Queue()
        self._worker: asyncio.Task[None] | None = None
        self._message = ""
        self._status = bus.topic(STATUS, TeachStatus)

    async def __aenter__(self) -> Self:
        bus = self._bus
        bus.advertise_service(ReadTeachStatus, self._read_status, namespace=NAMESPACE)
        bus.advertise_service(SetTriggers, self._set_triggers, namespace=NAMESPACE)
        bus.advertise_service(FireTrigger, self._fire_trigger, namespace=NAMESPACE)
        bus.advertise_service(TeachNow, self._teach_now, namespace=NAMESPACE)
        bus.advertise_service(ReadTriggerDocument, self._read_document, namespace=NAMESPACE)
        bus.advertise_service(WriteTriggerDocument, self._write_document, namespace=NAMESPACE)
        bus.advertise_service(ReadCapture, self._read_capture, namespace=NAMESPACE)
        bus.advertise_service(SaveCapture, self._save_capture, namespace=NAMESPACE)
        bus.advertise_service(DiscardCapture, self._discard_capture, namespace=NAMESPACE)
        bus.advertise_service(ProposeBehavior, self._propose, namespace=NAMESPACE)
        self._worker = asyncio.create_task(self._work(), name="helping hand")
        try:
            self._listen(self._file.load())
        except DocumentError as error:
            # Teaching works without triggers; the message tells the user to fix the file.
            self._say(f"the triggers are not active: {describe_cause(cause_of(error))}")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End recordings and guiding; captures stay in the buffer's folder."""
        self._deafen()
        for robot in tuple(self._recordings):
            self._end_recording(robot)
        self._bus.withdraw(NAMESPACE)
        worker, self._worker = self._worker, None
        if worker is not None:
            # Recorded data is kept before the end.
            await self._due.join()
            worker.cancel()
            await asyncio.wait((worker,))
        for guide in self._guides.values():
            guide.cancel()
            await guide.result()

    @property
    def status(self) -> TeachStatus:
        """The current status."""
        return TeachStatus(
            triggers=tuple(
                TriggerStatus(
                    trigger=one.trigger,
                    message_type=one.message_type,
                    pressed=one.detector is not None and one.detector.pressed,
                    fault=one.fault,
                )
                for one in self._listening
            ),
            captures=tuple(capture.summary for capture in self._buffer.captures),
            recording=tuple(self._recordings),
            guided=tuple(robot for robot, guide in self._guides.items() if not guide.finished),
            message=self._message,
        )

    def fired(self, trigger: Trigger, edge: ButtonEdge) -> None:
        """Execute the action of a trigger; `edge` is the change of its button."""
        held = trigger.trig_type == "hold"
        firing_edge = ButtonEdge.RELEASED if trigger.trig_type == "falling_edge" else ButtonEdge.PRESSED
        if trigger.trig_callback in _RECORDS:
            robot = self._robot_of(trigger)
            if robot is None:
                return
            running = robot in self._recordings
            if held and edge is ButtonEdge.RELEASED:
                self._end_recording(robot, of=trigger)
            elif edge is firing_edge and not (held and running):
                self._end_recording(robot) if running else self._begin_recording(robot, trigger)
        elif edge is firing_edge:
            self._due.put_nowait((trigger, lambda: self._do(trigger)))
        elif held and trigger.trig_callback == "grav_comp":
            self._due.put_nowait((trigger, lambda: self._guide(trigger, on=False)))
        self._publish_status()

    async def _do(self, trigger: Trigger) -> None:
        robot = self._robot_of(trigger)
        if robot is None and trigger.trig_callback != "tf_save":
            return
        match trigger.trig_callback:
            case "grav_comp":
                await self._guide(trigger, on=True if trigger.trig_type == "hold" else None)
            case "joint_save":
                self._took(await self._capturing.joints(trigger, robot or ""))
            case "pose_save":
                self._took(await self._capturing.pose(trigger, robot or ""))
            case "gripper_save":
                self._took(await self._capturing.gripper(trigger, robot or ""))
            case _:
                self._took(await self._capturing.frame(trigger, robot or ""))

    async def _guide(self, trigger: Trigger, *, on: bool | None) -> None:
        """Start or end hand guiding of the arm; `on` None toggles it."""
        robot = self._robot_of(trigger)
        if robot is None:
            return
        running = self._guides.get(robot)
        floating = running is not None and not running.finished
        if floating and on is not True:
            await self._bus.call(FinishGuiding(), to=robot)
            assert running is not None
            await running.result()
            self._say(f"{robot} holds its position")
        elif not floating and on is not False:
            guide = self._bus.send_goal(GuideArm(), to=robot)
            await guide.accepted()
            self._guides[robot] = guide
            self._say(f"{robot} can be guided by hand")

    def _begin_recording(self, robot: str, trigger: Trigger) -> None:
        try:
            self._recordings[robot] = (trigger, JointRecording(self._bus, robot))
            self._say(f"{robot} is being recorded")
        except BusError as error:
            self._say(describe_cause(cause_of(error)))

    def _end_recording(self, robot: str, *, of: Trigger | None = None) -> None:
        """End a recording, with `of` only that of one trigger; its data is queued for processing."""
        running = self._recordings.get(robot)
        if running is None or (of is not None and running[0] != of):
            return
        trigger, recording = self._recordings.pop(robot)

        async def keep() -> None:
            self._took(await self._capturing.recorded(trigger, recording))

        self._due.put_nowait((trigger, keep))

    def _robot_of(self, trigger: Trigger) -> str | None:
        """Return the robot of a trigger, and report if it is ambiguous."""
        name = trigger.robot_ns.strip("/")
        if name in self._robots:
            return name
        if not name and len(self._robots) == 1:
            return self._robots[0]
        known = ", ".join(self._robots) or "none"
        self._say(f"{trigger.trig_name}: " + (f"there is no robot {name}" if name else "name a robot") + f" ({known})")
        return None

    def _took(self, capture: Capture) -> None:
        self._say(f"capture {capture.summary.id} of {capture.summary.robot or 'the cell'}: {capture.summary.form}")

    async def _work(self) -> None:
        while True:
            trigger, work = await self._due.get()
            try:
                await work()
            except FlexcellError as error:
                self._say(f"{trigger.trig_name}: {describe_cause(cause_of(error))}")
            except Exception:
                # One capture that fails must not end teaching.
                _log.exception("%s failed", trigger.trig_name)
                self._say(f"{trigger.trig_name} failed; see the log for the reason")
            finally:
                self._due.task_done()

    def _listen(self, triggers: Sequence[Trigger]) -> None:
        self._deafen()
        self._listening = [self._listen_to(trigger) for trigger in triggers]
        self._publish_status()

    def _listen_to(self, trigger: Trigger) -> _TriggerSubscription:
        listening = _TriggerSubscription(trigger=trigger)
        name = trigger.trig_topic.strip("/")
        try:
            topic = self._bus.find_topic(name)
        except BusError:
            # No message was published there yet: the button has not been pressed.
            topic = self._bus.topic(name, ButtonState)
        listening.message_type = topic.kind.__name__
        try:
            detector = EdgeDetector(topic.kind, field=trigger.field, value=trigger.trig_value)
        except BusError as error:
            listening.fault = describe_cause(cause_of(error))
            return listening

        def take(message: object) -> None:
            edge = detector.take(message)
            if edge is not None:
                self.fired(trigger, edge)

        listening.detector = detector
        subscription = topic.subscribe_commands(take) if topic.kind is ButtonState else topic.subscribe(take)
        listening.close = subscription.close
        return listening

    def _deafen(self) -> None:
        for one in self._listening:
            one.close()
        self._listening = []

    def _say(self, words: str) -> None:
        self._message = words
        _log.info("%s", words)
        self._publish_status()

    def _publish_status(self) -> None:
        self._status.publish(self.status)

    async def _read_status(self, _request: ReadTeachStatus) -> TeachStatus:
        return self.status

    async def _set_triggers(self, request: SetTriggers) -> TeachStatus:
        names = [trigger.trig_name for trigger in request.triggers]
        if len(set(names)) < len(names):
            raise SkillFailed("two triggers have the same name", where=NAMESPACE, hint="give each its own name")
        return self._obey(self._file.write(request.triggers))

    async def _read_document(self, _request: ReadTriggerDocument) -> TriggerDocument:
        return TriggerDocument(file=self._file.name, text=self._file.text)

    async def _write_document(self, request: WriteTriggerDocument) -> TeachStatus:
        return self._obey(self._file.write_text(request.text))

    def _obey(self, triggers: Sequence[Trigger]) -> TeachStatus:
        for robot in tuple(self._recordings):
            self._end_recording(robot)
        self._listen(triggers)
        return self.status

    async def _teach_now(self, request: TeachNow) -> TeachStatus:
        lasts = request.callback in (*_RECORDS, "grav_comp")
        if request.callback in _RECORDS and not request.pressed:
            # Whichever trigger started it.
            self._end_recording(request.robot)
        else:
            trigger = Trigger(
                trig_name=_BY_HAND,
                robot_ns=request.robot,
                trig_topic=_BY_HAND,
                trig_type="hold" if lasts else "rising_edge",
                trig_callback=request.callback,
                source_frame=request.source_frame,
                target_frame=request.target_frame,
            )
            self.fired(trigger, ButtonEdge.PRESSED if request.pressed else ButtonEdge.RELEASED)
        await self._due.join()
        return self.status

    async def _fire_trigger(self, request: FireTrigger) -> TeachStatus:
        for one in self._listening:
            if one.trigger.trig_name == request.trig_name:
                self.fired(one.trigger, ButtonEdge.PRESSED if request.pressed else ButtonEdge.RELEASED)
                await self._due.join()
                return self.status
        known = ", ".join(one.trigger.trig_name for one in self._listening)
        raise SkillFailed(
            f"there is no trigger {request.trig_name!r}", where=NAMESPACE, hint=known or "set triggers first"
        )

    async def _read_capture(self, request: ReadCapture) -> Capture:
        return self._buffer.get(request.id)

    async def _save_capture(self, request: SaveCapture) -> EntryRecord:
        capture = self._buffer.get(request.id)
        record, kept = await save_capture(self._bus, capture, request)
        self._buffer.put(kept)
        self._say(f"capture {request.id} is saved as {record.kind} {record.name}")
        return record

    async def _discard_capture(self, request: DiscardCapture) -> TeachStatus:
        self._buffer.discard(request.id)
        self._publish_status()
        return self.status

    async def _propose(self, request: ProposeBehavior) -> Proposal:
        return await propose(self._bus, request)
