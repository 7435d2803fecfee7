"""Inspects a bus for a user interface: topics, skills and parameters with their schemas, traffic and goals."""

from __future__ import annotations

import inspect
from typing import Any, cast

import msgspec

from engine.bus.action import GoalEnd, GoalHandle
from engine.bus.bus import SkillBus
from engine.bus.json_bus import CLI_HOLDER, LocalJsonBus
from engine.bus.lease import Lease
from engine.bus.topic import Topic
from engine.document.parameter_spec import any_value
from engine.errors import BusError, FlexcellError
from engine.skill import Action

Schema = dict[str, Any]


class TopicInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A topic: its type, what that is for, and whether people may publish on it."""

    name: str
    type: str
    doc: str
    takes_commands: bool


class SkillInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A service or action: its address, the type of its request, what it is for, what it answers."""

    kind: str
    name: str
    type: str
    doc: str
    answer: str


class ParameterInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A parameter with its present value, and the JSON Schema of its values."""

    name: str
    doc: str
    value: object
    schema: Schema


class TopicStatistics(msgspec.Struct, frozen=True, kw_only=True):
    """What has passed on a topic: how many messages, when the latest, and whether it is made when somebody looks."""

    count: int
    latest_at_s: float | None
    on_demand: bool
    subscribers: int


class GoalInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A goal under way: who sent it, from which node, and its newest feedback."""

    id: str
    address: str
    run: str
    node: str
    status: str
    feedback: Any = None


class BusInspector:
    """A bus as a person at a screen sees it; used on the bus's loop."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus
        self._access = LocalJsonBus(bus)

    @property
    def now_s(self) -> float:
        """The bus's clock."""
        return self._bus.clock.now_s()

    def topics(self) -> tuple[TopicInfo, ...]:
        """Return all topics by name."""
        rows = (
            TopicInfo(name=t.name, type=t.kind.__name__, doc=_doc(t.kind), takes_commands=t.takes_commands)
            for t in self._bus.topics()
        )
        return tuple(sorted(rows, key=lambda row: row.name))

    def skills(self) -> tuple[SkillInfo, ...]:
        """Return all services and actions by address."""
        return tuple(
            SkillInfo(
                kind="action" if issubclass(skill, Action) else "service",
                name=address,
                type=skill.__name__,
                doc=_doc(skill),
                answer=_type_name(skill.result_type()),
            )
            for address, skill in sorted(self._bus.skills().items())
        )

    def parameters(self) -> tuple[ParameterInfo, ...]:
        """Return all parameters by name."""
        return tuple(
            ParameterInfo(name=each.name, doc=each.description, value=each.value, schema=_schema(each.kind))
            for each in self._bus.parameters.listing()
        )

    def shape(self) -> tuple[str, ...]:
        """Return what there is, in short: the names of topics and skills, and parameters with their values."""
        parameters = (f"{each.name}={each.value!r}" for each in self._bus.parameters.listing())
        return (*(topic.name for topic in self._bus.topics()), *self._bus.skills(), *parameters)

    def traffic(self) -> dict[str, TopicStatistics]:
        """Return what has passed on each topic; nothing is measured for it."""
        return {
            topic.name: TopicStatistics(
                count=topic.count,
                latest_at_s=topic.latest_at_s,
                on_demand=topic.is_made_on_demand,
                subscribers=topic.subscriber_count,
            )
            for topic in self._bus.topics()
        }

    def topic(self, name: str) -> Topic[Any]:
        """Return a topic; raises BusError when there is none of that name."""
        return self._bus.find_topic(name)

    def latest(self, name: str) -> object | None:
        """Return the newest message of a topic; None where there is none, or its device cannot say now."""
        try:
            return self._bus.find_topic(name).latest
        except FlexcellError:
            return None  # a screen shows a gap; who needs the message asks the topic itself

    def leases(self) -> tuple[Lease, ...]:
        """Return who commands what."""
        return self._bus.leases.held()

    def goals(self, run: str | None = None) -> tuple[GoalInfo, ...]:
        """Return the goals under way, of one run or of everybody, in the order in which they were sent."""
        return tuple(
            GoalInfo(
                id=goal.id,
                address=goal.address,
                run=goal.holder.run,
                node=goal.holder.branch,
                status=goal.status.value,
                feedback=goal.feedback,
            )
            for goal in self._bus.goals(run)
        )

    def request_schema(self, address: str) -> Schema:
        """Return the JSON Schema of what a service or action is asked; raises NoSuchSkill."""
        return _schema(self._bus.request_type(address))

    def message_schema(self, topic: str) -> Schema:
        """Return the JSON Schema of what is published on a topic; raises BusError."""
        return _schema(self._bus.find_topic(topic).kind)

    def set_parameter(self, name: str, value: object) -> object:
        """Set a parameter and return its value then; raises BusError when there is none, or the value does not fit."""
        self._bus.parameters.set(name, value)
        return self._bus.parameters.get(name)

    def cancel(self, goal: str) -> None:
        """Ask for the stop of a goal that a person sent; its end tells when the device rests.

        Raises:
            BusError: a run sent it, or there is no such goal under way.
        """
        for handle in self._bus.goals():
            if handle.id != goal:
                continue
            if handle.holder.run != CLI_HOLDER.run:
                raise BusError("this goal is of a run", where=goal, hint=f"stop run {handle.holder.run}")
            handle.cancel()
            return
        raise BusError("no such goal is under way", where=goal, hint="it may have ended by now")

    def send(self, address: str, goal: object) -> GoalHandle[Any, Any]:
        """Send a goal, to be followed by `ended`.

        Raises:
            BusError: there is no such action, it is a service, the goal does not fit, or a run holds the resource.
        """
        return self._access.send(address, goal)

    async def ended(self, handle: GoalHandle[Any, Any]) -> GoalEnd[Any]:
        """Wait for the end of a goal that was sent; cancelled, the goal is cancelled and awaited first."""
        return await self._access.ended(handle)


def _doc(kind: Any) -> str:
    """The docstring that a type has of its own."""
    own = cast("dict[str, object]", vars(kind)).get("__doc__")
    return inspect.cleandoc(own) if isinstance(own, str) else ""


def _type_name(kind: Any) -> str:
    return getattr(kind, "__name__", str(kind))


def _schema(kind: Any) -> Schema:
    try:
        return msgspec.json.schema(kind, schema_hook=any_value)
    except (TypeError, NotImplementedError) as error:
        what = f"{_type_name(kind)} cannot be described as a form: {error}"
        raise BusError(what, hint="use `flexcell bus`") from error
