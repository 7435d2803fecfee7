"""Curves of a recording: every peak is kept, pieces of a resumed run join, and rows have the names of their joints."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from editor_web.past.recorded_curves import RecordedCurves, RecordedPieces
from engine.errors import RecordingError
from engine.messages import GripperState, JointState
from tests.editor_web.past_recording import write_recording

WIDTH, FORCE = "left/gripper:width_m", "left/gripper:force_n"


def gripper(width_m: float, force_n: float = 0.0) -> GripperState:
    """A message with these numbers."""
    return GripperState(time_s=0.0, width_m=width_m, force_n=force_n, held=False)


def curves_of(
    files: Sequence[Path], fields: Sequence[str], from_s: float, until_s: float, cells: int
) -> RecordedCurves:
    """Read them, once."""
    with RecordedPieces(files) as pieces:
        return pieces.curves(fields, from_s=from_s, until_s=until_s, cells=cells)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A hundred widths in ten seconds, with one peak of force, after two silent seconds."""
    messages = [(2.0 + index / 10, gripper(index / 1000, 50.0 if index == 33 else 1.0)) for index in range(100)]
    folder = tmp_path_factory.mktemp("curves")
    return write_recording(folder / "r.mcap", {"left/gripper": messages})


@settings(max_examples=40)
@given(from_s=st.floats(0.0, 11.0), length_s=st.floats(0.1, 12.0), cells=st.integers(1, 40))
def test_no_peak_is_lost_and_none_is_made_up(recorded: Path, from_s: float, length_s: float, cells: int) -> None:
    """However coarse the cells are."""
    found = curves_of([recorded], [FORCE, WIDTH], from_s, from_s + length_s, cells)
    assert [len(column) for column in found.columns] == [2 * cells] * 2 == [len(found.times_s)] * 2
    assert list(found.times_s) == sorted(found.times_s)
    force, width = ([number for number in column if number is not None] for column in found.columns)
    assert set(force) <= {1.0, 50.0}
    assert width == sorted(width)
    if from_s + 0.001 < 5.3 < from_s + length_s - 0.001:
        assert 50.0 in force


def test_there_is_no_value_before_the_first_message(recorded: Path) -> None:
    """And after the last one its value holds, as on the bus."""
    (column,) = curves_of([recorded], [WIDTH], 0.0, 16.0, 8).columns
    assert column[:4] == (None, None, 0.0, 0.019)
    assert column[-5:] == (0.099,) * 5


def test_a_field_that_no_message_has_is_empty(recorded: Path) -> None:
    """And so is one of a topic that was not recorded."""
    found = curves_of([recorded], ["left/gripper:mass_kg", "nowhere:x", "no colon"], 2.0, 3.0, 2)
    assert found.columns == ((None,) * 4,) * 3


def test_a_resumed_run_is_one_curve(tmp_path: Path) -> None:
    """From the time at which it went on, the later recording counts."""
    first = write_recording(tmp_path / "1.mcap", {"left/gripper": [(t / 2, gripper(0.01)) for t in range(1, 12)]})
    second = write_recording(
        tmp_path / "2.mcap", {"left/gripper": [(3.0 + t / 2, gripper(0.05)) for t in range(6)]}, since_s=3.0
    )
    (column,) = curves_of([first, second], [WIDTH], 0.0, 6.0, 3).columns
    assert column == (0.01, 0.01, 0.01, 0.05, 0.05, 0.05)


def test_rows_have_the_names_of_their_joints(tmp_path: Path) -> None:
    """As on the bus."""
    state = JointState(
        time_s=0.0, names=("lift", "turn"), position_rad=(0.1, 0.2), velocity_rad_s=(0.0, 0.0), effort_nm=(3.0, 4.0)
    )
    file = write_recording(tmp_path / "r.mcap", {"left/joint_state": [(1.0, state)]})
    with RecordedPieces([file]) as pieces:
        (topic,) = pieces.fields().topics
    assert (topic.topic, topic.type) == ("left/joint_state", "JointState")
    assert {field.path: (field.label, field.unit) for field in topic.fields}["effort_nm.1"] == ("effort_nm turn", "Nm")


def test_a_run_without_a_recording_says_how_runs_are_recorded() -> None:
    """For there is nothing to draw."""
    with pytest.raises(RecordingError, match=r"no recording .*--record"):
        RecordedPieces([])
