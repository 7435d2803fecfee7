"""Inspects a bus for a user interface: topics, skills and parameters with their schemas, traffic and goals."""

from __future__ import annotations

import inspect
from typing import Any, cast

import msgspec

from engine.bus.action import GoalHandle
from engine.bus.bus import SkillBus
from engine.bus.json_bus import CLI_HOLDER, LocalJsonBus
from engine.bus.lease import Lease
from engine.bus.topic import Topic
from engine.document.parameter_spec import any_value
from engine.errors import BusError, FlexcellError
from engine.skill import Action
from engine.skills.goal_end import GoalEnd

Schema = dict[str, Any]


class TopicInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A topic: its message type with its documentation, and whether users may publish on it."""

    name: str
    type: str
    doc: str
    takes_commands: bool


class SkillInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A service or action: its address, request type, documentation and response type."""

    kind: str
    name: str
    type: str
    doc: str
    answer: str


class ParameterInfo(msgspec.Struct, frozen=True, kw_only=True):
    """A parameter with its present value and the JSON Schema of its values."""

    name: str
    doc: str
    value: object
    schema: Schema


class TopicStatistics(msgspec.Struct, frozen=True, kw_only=True):
    """Statistics of a topic: message count, time of the latest, and whether a provider makes it on demand."""

    count: int
    latest_at_s: float | None
    on_demand: bool
    subscribers: int


class GoalInfo(msgspec.Struct, frozen=True, kw_only=True):
    """An active goal: its run and node, and its latest feedback."""

    id: str
    address: str
    run: str
    node: str
    status: str
    feedback: Any = None


class BusInspector:
    """A view of a bus for a user interface; used on the bus's loop."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus
        self._access = LocalJsonBus(bus)

    @property
    def now_s(self) -> float:
        """The time of the bus's clock."""
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
        """Return a summary of the bus: the names of topics and skills, and parameters with their values."""
        parameters = (f"{each.name}={each.value!r}" for each in self._bus.parameters.listing())
        return (*(topic.name for topic in self._bus.topics()), *self._bus.skills(), *parameters)

    def traffic(self) -> dict[str, TopicStatistics]:
        """Return the statistics of each topic; triggers no measurement."""
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
        """Return a topic; raises BusError when it does not exist."""
        return self._bus.find_topic(name)

    def latest(self, name: str) -> object | None:
        """Return the latest message of a topic; None when there is none or its device cannot provide it now."""
        try:
            return self._bus.find_topic(name).latest
        except FlexcellError:
            return None  # a user interface shows a gap; code that needs the message reads the topic itself

    def leases(self) -> tuple[Lease, ...]:
        """Return all leases with their holders."""
        return self._bus.leases.held()

    def goals(self, run: str | None = None) -> tuple[GoalInfo, ...]:
        """Return the active goals of one run, or of all holders when None, in the order sent."""
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
        """Return the JSON Schema of the request of a service or action; raises NoSuchSkill."""
        return _schema(self._bus.request_type(address))

    def message_schema(self, topic: str) -> Schema:
        """Return the JSON Schema of the messages of a topic; raises BusError."""
        return _schema(self._bus.find_topic(topic).kind)

    def set_parameter(self, name: str, value: object) -> object:
        """Set a parameter and return its new value; raises BusError when it does not exist or the value is invalid."""
        self._bus.parameters.set(name, value)
        return self._bus.parameters.get(name)

    def cancel(self, goal: str) -> None:
        """Cancel a goal that a user sent; the goal ends when the device is at rest.

        Raises:
            BusError: a run sent the goal, or there is no such active goal.
        """
        for handle in self._bus.goals():
            if handle.id != goal:
                continue
            if handle.holder.run != CLI_HOLDER.run:
                raise BusError("this goal belongs to a run", where=goal, hint=f"stop run {handle.holder.run}")
            handle.cancel()
            return
        raise BusError("no such active goal", where=goal, hint="the goal may have ended")

    def send(self, address: str, goal: object) -> GoalHandle[Any, Any]:
        """Send a goal; then await `ended`.

        Raises:
            BusError: no such action, a service, an invalid goal, or a resource held by a run.
        """
        return self._access.send(address, goal)

    async def ended(self, handle: GoalHandle[Any, Any]) -> GoalEnd[Any]:
        """Wait for the end of a sent goal; on cancellation, cancel the goal and wait for its end first."""
        return await self._access.ended(handle)


def _doc(kind: Any) -> str:
    """Return the docstring of a type, without inherited ones."""
    own = cast("dict[str, object]", vars(kind)).get("__doc__")
    return inspect.cleandoc(own) if isinstance(own, str) else ""


def _type_name(kind: Any) -> str:
    return getattr(kind, "__name__", str(kind))


def _schema(kind: Any) -> Schema:
    try:
        return msgspec.json.schema(kind, schema_hook=any_value)
    except (TypeError, NotImplementedError) as error:
        message = f"no JSON Schema can be made of {_type_name(kind)}: {error}"
        raise BusError(message, hint="use `flexcell bus`") from error
