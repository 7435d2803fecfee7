"""The recordings of the other applications are small and those of the behaviors as they are.

Each recording is a test of its own, collected by the pytest plugin from this folder. When what happens
in an application changes on purpose: `python tests/replay/make_recordings.py NAME`.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document import load_behavior
from engine.recording import load_recording, recorded_behavior

FOLDER = Path(__file__).parent
BEHAVIORS = FOLDER.parents[1] / "behaviors"
APPLICATIONS = [
    ("pick_and_place", "pick_and_place", "ur10", "ur10"),
    ("plate_transfer", "plate_transfer", "irb4600", "irb4600"),
    ("plate_transfer_shared", "plate_transfer_shared", "irb4600_shared", "irb4600"),
    ("plate_transfer_shared", "plate_transfer_fixed", "irb4600", "irb4600"),
    ("test_cylinder", "test_cylinder", "servo_arm", "servo_arm"),
]


@pytest.mark.parametrize(("folder", "name", "cell", "entries"), APPLICATIONS)
def test_the_recording_is_small_and_that_of_the_present_behavior(
    folder: str, name: str, cell: str, entries: str
) -> None:
    file = FOLDER / f"{name}.mcap"
    assert file.stat().st_size < 150_000
    recording = load_recording(file)
    again = f"make it again: python tests/replay/make_recordings.py {name}"
    behavior = load_behavior(BEHAVIORS / folder / f"{name}.yaml")
    assert recorded_behavior(recording.documents).meaning == behavior.meaning, again
    assert (recording.description.clock, recording.description.seed) == ("virtual", 1)
    documents = {f"{folder}/{name}.yaml", f"cells/{cell}.yaml", f"entries/{entries}.yaml"}
    assert documents <= set(recording.documents.texts)
