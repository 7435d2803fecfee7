"""What there was to draw at a moment of a recorded run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import msgspec

from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.errors import RecordingError
from engine.messages import FramePoses, RobotDescription, SceneDescription
from engine.messages.sensing import CameraInfo, OccupancyGrid, OccupancyState
from engine.recording.indexed_recording import IndexedRecording
from engine.skills.planning import PathPreview
from engine.skills.planning_scene import PlanningSceneState
from engine.skills.vision import Detections

_KINDS: tuple[type[msgspec.Struct], ...] = (
    RobotDescription,
    SceneDescription,
    FramePoses,
    PlanningSceneState,
    PathPreview,
    CameraInfo,
    OccupancyState,
    OccupancyGrid,
    Detections,
)
_DECODERS: Mapping[str, msgspec.json.Decoder[Any]] = {kind.__name__: msgspec.json.Decoder(kind) for kind in _KINDS}
_NO_VOXELS = OccupancyGrid(
    time_s=0.0, revision=0, corner_m=(0.0, 0.0, 0.0), voxel_m=0.01, shape=(0, 0, 0), occupied=b""
)
_EMPTY_SCENE = PlanningSceneState(revision=0, obstacles=(), held=(), allowed=())


class RecordedScene:
    """The recordings of one run, open; on one thread. A run that was resumed has several, oldest first.

    Raises:
        RecordingError: one cannot be read, or there is none.
    """

    def __init__(self, files: Sequence[Path]) -> None:
        self.files = tuple(files)
        self._read: dict[str, tuple[object, object]] = {}
        with ExitStack() as stack:
            self._pieces = tuple(stack.enter_context(IndexedRecording.open(file)) for file in files)
            self._open = stack.pop_all()
        if not self._pieces:
            raise RecordingError("there is no recording of this run")

    def close(self) -> None:
        """Close the files."""
        self._open.close()

    @property
    def span_s(self) -> tuple[float, float]:
        """The times of the run from which on and to which it can be shown, now."""
        self._pieces[-1].refresh()
        return self._pieces[0].span_s[0], self._pieces[-1].span_s[1]

    def show(self, newest: LatestMessages, time_s: float) -> None:
        """Fill `newest` with what was the newest at a time of the run.

        Raises:
            RecordingError: the recording is damaged.
        """
        self._pieces[-1].refresh()
        piece = next((each for each in reversed(self._pieces) if each.span_s[0] <= time_s), self._pieces[0])
        for topic, kind in piece.topics.items():
            if kind in _DECODERS:
                message = self._message(piece, topic, kind, time_s)
                if message is not None:
                    newest.put(topic.rpartition("/")[0], message)

    def _message(self, piece: IndexedRecording, topic: str, kind: str, time_s: float) -> object | None:
        found = piece.at(topic, time_s)
        if found is None:
            return _nothing(topic, kind)
        # The same message is the same object: that is how whoever draws it knows that nothing has changed.
        place = (piece.path, found.place)
        known = self._read.get(topic)
        if known is None or known[0] != place:
            try:
                known = self._read[topic] = (place, _DECODERS[kind].decode(found.data))
            except msgspec.MsgspecError as error:
                raise RecordingError(f"a message of {topic} cannot be read: {error}", where=piece.path) from error
        return known[1]


def _nothing(topic: str, kind: str) -> object | None:
    """Return what is shown before the first message of a topic, where a later one may be drawn already."""
    name = topic.rpartition("/")[0]
    if kind == PathPreview.__name__:
        return PathPreview(robot=name, state="none")
    if kind == Detections.__name__:
        return Detections(camera=name, frame="world", time_s=0.0, detections=(), image_px=(0, 0))
    if kind == OccupancyGrid.__name__:
        return _NO_VOXELS
    return _EMPTY_SCENE if kind == PlanningSceneState.__name__ else None
