"""Replays a recording for a test; implements the pytest fixture `flexcell_replay`."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from engine.document import load_behavior
from engine.recording import load_recording
from engine.replay import ReplayReport, replay
from engine.runtime.plan import Catalogue


class RecordingReplayer(Protocol):
    """The type of the fixture `flexcell_replay`."""

    def __call__(self, file: Path | str, *, behavior: Path | str | None = None) -> ReplayReport:
        """Replay a recording, with another version of its behavior if one is given."""
        ...


def replay_file(file: Path | str, *, catalogue: Catalogue, behavior: Path | str | None = None) -> ReplayReport:
    """Replay a recording.

    Raises:
        FlexcellError: the recording or the behavior cannot be used.
    """
    changed = load_behavior(Path(behavior)) if behavior is not None else None
    return replay(load_recording(Path(file)), catalogue, behavior=changed)
