"""The scene of a recorded run at a point in time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import msgspec

from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.errors import RecordingError
from engine.messages import FramePoses, JointSetPoint, RobotDescription, SceneDescription
from engine.messages.sensing import CameraInfo, OccupancyGrid, OccupancyState
from engine.recording import IndexedRecording
from engine.skills.planning import PathPreview
from engine.skills.planning_scene import PlanningSceneState
from engine.skills.vision import Detections

_KINDS: tuple[type[msgspec.Struct], ...] = (
    RobotDescription,
    SceneDescription,
    FramePoses,
    JointSetPoint,
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
    """The open recordings of one run, for use on one thread. A resumed run has several, oldest first.

    Raises:
        RecordingError: a recording cannot be read, or there is none.
    """

    def __init__(self, files: Sequence[Path]) -> None:
        self.files = tuple(files)
        self._read: dict[str, tuple[object, object]] = {}
        with ExitStack() as stack:
            self._pieces = tuple(stack.enter_context(IndexedRecording.open(file)) for file in files)
            self._open = stack.pop_all()
        if not self._pieces:
            raise RecordingError("this run has no recording")

    def close(self) -> None:
        """Close the files."""
        self._open.close()

    @property
    def span_s(self) -> tuple[float, float]:
        """The start and end time of the recorded part of the run, as of now."""
        self._pieces[-1].refresh()
        return self._pieces[0].span_s[0], self._pieces[-1].span_s[1]

    def show(self, latest: LatestMessages, time_s: float) -> None:
        """Fill `latest` with the latest messages at a time of the run.

        Raises:
            RecordingError: the recording is damaged.
        """
        self._pieces[-1].refresh()
        piece = next((each for each in reversed(self._pieces) if each.span_s[0] <= time_s), self._pieces[0])
        for topic, kind in piece.topics.items():
            if kind in _DECODERS and (kind != JointSetPoint.__name__ or _is_of_real_arm(piece, topic)):
                message = self._message(piece, topic, kind, time_s)
                if message is not None:
                    latest.put(topic.rpartition("/")[0], message)

    def _message(self, piece: IndexedRecording, topic: str, kind: str, time_s: float) -> object | None:
        recorded = piece.at(topic, time_s)
        if recorded is None:
            return _initial_message(topic, kind)
        # The same message must be the same object: the layers detect changes by identity.
        place = (piece.path, recorded.place)
        known = self._read.get(topic)
        if known is None or known[0] != place:
            try:
                known = self._read[topic] = (place, _DECODERS[kind].decode(recorded.data))
            except msgspec.MsgspecError as error:
                raise RecordingError(f"a message of {topic} cannot be read: {error}", where=piece.path) from error
        return known[1]


def _is_of_real_arm(piece: IndexedRecording, set_point: str) -> bool:
    """Return whether the set points of an arm were recorded as they changed; those of simulated arms are not."""
    return f"{set_point.rpartition('/')[0]}/device" in piece.topics


def _initial_message(topic: str, kind: str) -> object | None:
    """Return the message for a time before the first one of a topic; it clears a later one that is drawn."""
    name = topic.rpartition("/")[0]
    if kind == PathPreview.__name__:
        return PathPreview(robot=name, state="none")
    if kind == JointSetPoint.__name__:
        return JointSetPoint(time_s=0.0, names=(), position_rad=())
    if kind == Detections.__name__:
        return Detections(camera=name, frame="world", time_s=0.0, detections=(), image_px=(0, 0))
    if kind == OccupancyGrid.__name__:
        return _NO_VOXELS
    return _EMPTY_SCENE if kind == PlanningSceneState.__name__ else None
