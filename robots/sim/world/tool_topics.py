"""The topic of an arm's tool: `<arm>/<kind of tool>/state`."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Generic, Protocol, TypeVar

from engine.bus import SkillBus, Topic
from engine.messages import Message
from robots.sim.grip.tool_reading import state_publisher
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.snapshot import ArmSummary, SimSnapshot
from robots.tool_kinds import tool_kind

State = TypeVar("State", bound=Message)


class ToolTopic(Protocol):
    """The state of one tool on the bus."""

    @property
    def read(self) -> bool:
        """True while it has subscribers."""
        ...

    def publish(self, snapshot: SimSnapshot) -> None:
        """Publish the state in a snapshot."""
        ...


class StateTopic(Generic[State]):
    """A tool's state as a topic: computed on demand for the latest value, streamed to subscribers."""

    def __init__(self, topic: Topic[State], host: WorldHost, state: Callable[[SimSnapshot], State]) -> None:
        self._topic = topic
        self._state = state
        topic.provide(lambda: state(host.snapshot()))

    @property
    def read(self) -> bool:
        """True while it has subscribers."""
        return self._topic.subscriber_count > 0

    def publish(self, snapshot: SimSnapshot) -> None:
        """Publish the state in a snapshot."""
        self._topic.publish(self._state(snapshot))


def tool_topic(bus: SkillBus, host: WorldHost, arm: ArmSummary, *, parts: Collection[str]) -> ToolTopic | None:
    """Return the topic of an arm's tool, None for a bare flange."""
    tool, name = arm.tool, arm.name
    if tool is None:
        return None
    publisher = state_publisher(tool.kind)

    def state(snapshot: SimSnapshot) -> Message:
        return publisher.state(snapshot.tool(name), tool, parts=parts)

    return StateTopic(bus.topic(f"{name}/{tool.kind}/state", tool_kind(tool.kind).measured), host, state)
