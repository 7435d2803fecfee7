"""The numbers of messages and how much of a message is shown."""

from __future__ import annotations

import json
from typing import Any

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from editor_web.telemetry.plot_signals import number_at, path_of, signal_fields, unit_of
from editor_web.telemetry.truncate import MAX_LEAVES, truncate_value
from engine.messages import GripperState, JointState, Pose

JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**60), 2**60) | st.floats() | st.text(max_size=900) | st.binary(),
    lambda inner: st.lists(inner, max_size=70) | st.dictionaries(st.text(max_size=8), inner, max_size=70),
    max_leaves=60,
)


def test_the_joints_of_an_arm_are_named_with_their_units() -> None:
    """As the message names them."""
    state = JointState(
        time_s=1.0, names=("lift", "turn"), position_rad=(0.1, 0.2), velocity_rad_s=(0.0, 0.0), effort_nm=(3.0, 4.0)
    )
    fields = {each.path: (each.label, each.unit) for each in signal_fields(state)}
    assert fields["position_rad.1"] == ("position_rad turn", "rad")
    assert fields["velocity_rad_s.0"] == ("velocity_rad_s lift", "rad/s")
    assert fields["effort_nm.1"] == ("effort_nm turn", "Nm")
    assert number_at(state, path_of("effort_nm.1")) == 4.0
    assert [number_at(state, path_of(path)) for path in ("effort_nm.9", "names.0", "effort_nm", "x.y", "")] == [
        None
    ] * 5


def test_axes_and_truth_values_are_signals() -> None:
    """A pose has x, y and z in metres; held is 0 or 1."""
    fields = [(each.label, each.unit) for each in signal_fields(Pose(xyz=(1.0, 2.0, 3.0)))]
    assert fields[:3] == [("xyz x", "m"), ("xyz y", "m"), ("xyz z", "m")]
    gripper = GripperState(time_s=0.0, width_m=0.03, force_n=20.0, held=True)
    assert number_at(gripper, ("held",)) == 1.0
    assert [unit_of(name) for name in ("width_m", "force_n", "m", "closed_percent", "limit_m_s2", "name")] == [
        "m",
        "N",
        "",
        "%",
        "m/s²",
        "",
    ]


@given(value=JSON)
def test_every_number_that_is_offered_can_be_read(value: Any) -> None:
    """Whatever the message is; infinite ones are gaps."""
    for field in signal_fields(value):
        number = number_at(value, path_of(field.path))
        assert number is None or isinstance(number, float)


def test_a_path_that_no_message_has_reads_nothing() -> None:
    """However long its numbers are: pages write paths too."""
    for text in ("9" * 5000, "²", "-1", ".", "a." * 1000):
        assert number_at({"a": [1.0]}, path_of(text)) is None


@given(value=JSON)
def test_whatever_is_truncated_is_json(value: Any) -> None:
    """Also numbers that JSON does not know."""
    json.loads(msgspec.json.encode(truncate_value(value)))
    assert truncate_value(value) == truncate_value(value)


def test_what_is_truncated_is_small_however_large_the_message_is() -> None:
    """Wide, deep, long."""
    deep: object = 1
    for _ in range(100):
        deep = {"inner": deep}
    wide = {str(i): {str(j): list(range(100)) for j in range(100)} for i in range(100)}
    for huge in (deep, wide, [wide] * 50, "x" * 10_000_000, b"x" * 10_000_000):
        assert len(msgspec.json.encode(truncate_value(huge))) < 20 * MAX_LEAVES
