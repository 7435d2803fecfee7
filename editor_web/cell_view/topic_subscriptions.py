"""Topic subscriptions of the 3D view: some permanent, the expensive ones only while a page shows them."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol

from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import LayerGroup
from engine.bus import JsonBus
from engine.errors import FlexcellError
from engine.messages import FramePoses, JointSetPoint, RobotDescription, SceneDescription
from engine.messages.device_state import DeviceState
from engine.messages.sensing import CameraInfo, DepthImage, ObservedSpace, OccupancyGrid, OccupancyState
from engine.skills.jogging import JogBlock
from engine.skills.planning import PathPreview
from engine.skills.planning_scene import PlanningSceneState
from engine.skills.vision import Detections

_log = logging.getLogger("flexcell.cell_view")
# By type, not by name: the cell chooses the names of arms and cameras. Descriptions come first, because they say
# which bodies of the scene belong to arms.
_ALWAYS = (RobotDescription, SceneDescription, FramePoses, PlanningSceneState, PathPreview, JogBlock, CameraInfo)
# Cameras take images only while their data is subscribed.
_WHILE_SHOWN: dict[str, LayerGroup] = {
    OccupancyState.__name__: "voxels",
    OccupancyGrid.__name__: "voxels",
    ObservedSpace.__name__: "voxels",
    DepthImage.__name__: "cameras",
    Detections.__name__: "detections",
}
_RANK = {kind.__name__: rank for rank, kind in enumerate(_ALWAYS)}


class TopicSource(Protocol):
    """The part of the backend that the 3D view uses."""

    @property
    def bus(self) -> JsonBus:
        """The bus, for the list of topics."""
        ...

    def recording_files(self, run_id: str) -> Sequence[Path]:
        """Return the recordings of a run, oldest first; `run_id` may be the path of a recording."""
        ...

    def subscribe_topic(self, topic: str, callback: Callable[[object], None]) -> Callable[[], None]:
        """Call `callback` with the latest message of a topic at once, then with every new one."""
        ...


class TopicSubscriptions:
    """Subscribes to the topics to draw; only on the event loop's thread.

    Args:
        topics: The source of the topics.
        latest: Receives every message.
        shown: Returns the groups that are shown now.
    """

    def __init__(
        self, topics: TopicSource, latest: LatestMessages, *, shown: Callable[[], frozenset[LayerGroup]]
    ) -> None:
        self._topics = topics
        self._latest = latest
        self._shown = shown
        self._unsubscribers: dict[str, Callable[[], None]] = {}
        self._asked = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Subscribe to the current topics; `ask` updates the subscriptions later."""
        await self._follow()
        self._task = asyncio.create_task(self._keep_up(), name="cell view topics")

    async def close(self) -> None:
        """Unsubscribe from all topics."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})
            self._task = None
        for unsubscribe in self._unsubscribers.values():
            unsubscribe()
        self._unsubscribers = {}

    def ask(self) -> None:
        """Request an update of the subscriptions."""
        self._asked.set()

    async def _keep_up(self) -> None:
        while True:
            await self._asked.wait()
            self._asked.clear()
            await self._follow()

    async def _follow(self) -> None:
        entries = [entry for entry in await self._topics.bus.listing() if entry.kind == "topic"]
        shown = self._shown()
        real = {entry.name.rpartition("/")[0] for entry in entries if entry.type == DeviceState.__name__}
        due = {
            entry.name: _RANK.get(entry.type, len(_RANK))
            for entry in entries
            if entry.type in _RANK
            or _WHILE_SHOWN.get(entry.type) in shown
            # Set points of simulated arms are made when they are read, and never published.
            or (entry.type == JointSetPoint.__name__ and entry.name.rpartition("/")[0] in real)
        }
        for topic in [name for name in self._unsubscribers if name not in due]:
            self._unsubscribers.pop(topic)()
        for topic in sorted(due, key=lambda name: (due[name], name)):
            if topic not in self._unsubscribers:
                self._subscribe(topic)

    def _subscribe(self, topic: str) -> None:
        name = topic.rpartition("/")[0]
        try:
            self._unsubscribers[topic] = self._topics.subscribe_topic(
                topic, lambda message: self._latest.put(name, message)
            )
        except FlexcellError as error:
            _log.info("nothing to draw from %s: %s", topic, error)
