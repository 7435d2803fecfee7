"""The topic of an arm's tool: `<arm>/gripper/state`, `<arm>/hand/state` or `<arm>/magnet/state`."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Generic, Protocol, TypeVar

from engine.bus import SkillBus, Topic
from engine.messages import GripperState, HandState, MagnetState, Message
from robots.port.hand_grasp_check import hand_state
from robots.port.magnet_grasp_check import magnet_state
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.snapshot import ArmSummary, SimSnapshot

State = TypeVar("State", bound=Message)

# Both pads press at least this hard on the same part before it counts as held.
_HELD_N = 1.0


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
    address = f"{name}/{tool.device}/state"
    match tool.device:
        case "gripper":
            return StateTopic(
                bus.topic(address, GripperState), host, lambda snapshot: _gripper_state(snapshot, name, parts)
            )
        case "hand":
            return StateTopic(
                bus.topic(address, HandState),
                host,
                lambda snapshot: hand_state(snapshot.hand(name), max_force_n=tool.max_force_n),
            )
        case "magnet":
            return StateTopic(
                bus.topic(address, MagnetState),
                host,
                lambda snapshot: magnet_state(snapshot.magnet(name), max_force_n=tool.max_force_n),
            )


def _gripper_state(snapshot: SimSnapshot, arm: str, parts: Collection[str]) -> GripperState:
    sample = snapshot.gripper(arm)
    left, right = sample.contacts
    return GripperState(
        time_s=sample.time_s,
        width_m=sample.width_m,
        force_n=sample.force_n,
        held=left == right and left in parts and sample.force_n >= _HELD_N,
    )
