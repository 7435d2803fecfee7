"""Data with arrays crosses to another process as it is; what is no data does not."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np
import pytest

from robots.control.commanding.arm_commands import FollowTrajectory, TrackForce
from robots.io.message_codec import encode_payload, payload_decoder
from robots.port import Array, ContactCondition, ForceTask, JointTrajectory, Tolerance

TRAJECTORY = JointTrajectory(
    dt_s=0.01, position_rad=np.arange(6.0).reshape(3, 2), velocity_rad_s=np.zeros((3, 2), order="F")
)
Command = FollowTrajectory | TrackForce
command: Callable[[bytes], Command] = payload_decoder(Command)


class Numbers(msgspec.Struct, frozen=True, kw_only=True):
    """An array of any shape."""

    values: Array


numbers: Callable[[bytes], Numbers] = payload_decoder(Numbers)


def crossed(values: Array) -> Array:
    """Return an array as the other process receives it."""
    return numbers(encode_payload(Numbers(values=values))).values


@pytest.mark.parametrize("shape", [(), (0,), (3,), (0, 7), (4, 7), (2, 3, 4)])
def test_an_array_arrives_with_its_shape_and_numbers_and_may_be_written(shape: tuple[int, ...]) -> None:
    sent = np.random.default_rng(1).normal(size=shape)
    received = crossed(np.asarray(sent))
    assert (received.shape, received.dtype) == (shape, np.float64)
    assert received.tolist() == np.asarray(sent).tolist()
    assert received.flags.writeable
    assert received.flags.c_contiguous


def test_parts_of_arrays_and_arrays_of_other_numbers_arrive_as_float64_row_by_row() -> None:
    grid = np.arange(12.0).reshape(3, 4)
    assert crossed(grid.T[::2]).tolist() == grid.T[::2].tolist()
    assert crossed(np.array([[1, 2], [3, 4]])).tolist() == [[1.0, 2.0], [3.0, 4.0]]


def test_a_trajectory_its_tolerance_and_its_contact_cross_as_they_are() -> None:
    sent = FollowTrajectory(
        arm="left",
        motion=3,
        trajectory=TRAJECTORY,
        tolerance=Tolerance(path_rad=0.2),
        until=ContactCondition(force_n=5.0, direction=(0.0, 0.0, 1.0)),
    )
    received = command(encode_payload(sent))
    assert isinstance(received, FollowTrajectory)
    assert (received.arm, received.motion) == ("left", 3)
    assert (received.tolerance, received.until) == (sent.tolerance, sent.until)
    assert received.trajectory.dt_s == TRAJECTORY.dt_s
    np.testing.assert_array_equal(received.trajectory.position_rad, TRAJECTORY.position_rad)
    np.testing.assert_array_equal(received.trajectory.velocity_rad_s, TRAJECTORY.velocity_rad_s)


def test_a_force_task_crosses_as_it_is() -> None:
    task = ForceTask(trajectory=TRAJECTORY, offset=np.ones((3, 6)), wrench=np.zeros((3, 6)), slow_per_n=0.1)
    sent = TrackForce(arm="left", motion=1, task=task, tolerance=Tolerance())
    received = command(encode_payload(sent))
    assert isinstance(received, TrackForce)
    assert (received.task.admittance, received.task.slow_per_n) == (task.admittance, 0.1)
    np.testing.assert_array_equal(received.task.offset, task.offset)
    np.testing.assert_array_equal(received.task.wrench, task.wrench)


@pytest.mark.parametrize("values", [3, [[2], b"123"], [[5], bytes(16)], [[-2], bytes(8)], ["two", bytes(16)], [[2]]])
def test_what_is_no_array_is_an_invalid_message(values: object) -> None:
    with pytest.raises(msgspec.ValidationError):
        numbers(msgspec.msgpack.encode({"values": values}))


def test_what_is_no_data_is_not_sent() -> None:
    with pytest.raises(NotImplementedError, match="object cannot be sent to another process"):
        encode_payload(object())
