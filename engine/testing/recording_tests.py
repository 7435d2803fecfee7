"""Recordings as pytest tests: one test per recording, which replays it and fails with the differences."""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from pathlib import Path

import pytest

from engine.errors import FlexcellError
from engine.recording import load_recording
from engine.registry import load_states
from engine.replay import ReplayDifference, replay

MARKER = "flexcell_replay"


class RecordingTestFile(pytest.File):
    """The pytest collector of a recording."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield its only test."""
        item: RecordingTestItem = RecordingTestItem.from_parent(self, name=self.path.stem)  # pyright: ignore[reportUnknownMemberType]
        item.add_marker(MARKER)
        yield item


class RecordingTestItem(pytest.Item):
    """Replays one recording."""

    def runtest(self) -> None:
        """Replay it; raises errors that `repr_failure` formats."""
        recording = load_recording(self.path)
        description = recording.description
        for name, value in (("run", description.run), ("document_sha256", description.document)):
            self.user_properties.append((name, value))
        report = replay(recording, load_states(self.config.rootpath))
        if not report.same:
            raise ReplayDiffers(report.differences)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: object = None) -> str:
        """Return the difference, or why the recording cannot be replayed; no traceback of the engine."""
        error = excinfo.value
        if isinstance(error, ReplayDiffers):
            return "\n".join(f"{self.path}: {each.explained()}" for each in error.differences)
        if isinstance(error, FlexcellError):
            return str(error) if str(self.path) in str(error) else f"{self.path}: {error}"
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[PathLike[str], int | None, str]:
        """Return its path, and its name in the summary."""
        return Path(self.path), None, f"replay of {self.name}"


class ReplayDiffers(AssertionError):
    """A replay differs from its recording."""

    def __init__(self, differences: tuple[ReplayDifference, ...]) -> None:
        super().__init__("; ".join(map(str, differences)))
        self.differences = differences
