"""Contacts, grasps, forces and limits of a run: what its goals measured, and what its recording shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import msgspec
import pytest

from editor_web.past.measured_marker import MeasuredMarker
from editor_web.past.measured_run import NOT_RECORDED, STILL_ACTIVE, MeasuredRun
from editor_web.past.telemetry_markers import APART_S
from engine.event import Event, GoalFinished, GoalSent
from engine.messages import JointState, Pose, RobotDescription, Wrench
from engine.messages.device_state import DeviceState
from engine.skills.arm_control import ArmMode, ArmStatus, ControlSettings
from tests.editor_web.past_recording import RecordedMessages, write_recording

Goal = tuple[float, float, str, dict[str, object], dict[str, object] | None]
"""From when to when, at which address, what was asked for, and the result."""


def events_of(*goals: Goal) -> list[Event]:
    """A run of these goals one after the other, each of a node of its own."""
    events: list[Event] = []
    for number, (from_s, until_s, address, request, result) in enumerate(goals, 1):
        path = f"root/step_{number}"
        events.append(
            GoalSent(
                seq=len(events) + 1, time_s=from_s, path=path, goal=f"{path}#1.1", address=address, request=request
            )
        )
        events.append(
            GoalFinished(
                seq=len(events) + 1, time_s=until_s, path=path, goal=f"{path}#1.1", status="succeeded", result=result
            )
        )
    return events


def marks_of(
    events: Sequence[Event], folder: Path | None = None, said: RecordedMessages | None = None
) -> tuple[MeasuredMarker, ...]:
    """The markers of a run that has ended, with these messages in its recording."""
    files = () if folder is None or said is None else (write_recording(folder / "r.mcap", said),)
    return MeasuredRun().markers(events, files, has_ended=True).marks


def numbers_of(marks: Sequence[MeasuredMarker]) -> list[tuple[str, float, str, float | None, float | None]]:
    """What markers say in numbers: kind, time, node, value, limit."""
    return [(mark.kind, mark.time_s, mark.path, mark.value, mark.limit) for mark in marks]


def arm(name: str = "left") -> RobotDescription:
    """An arm of two joints, from -1 to 1 rad, 2 rad/s, 10 N m."""
    return RobotDescription(
        name=name, model="m", urdf="", joint_names=("lift", "turn"), lower_rad=(-1.0, -1.0), upper_rad=(1.0, 1.0),
        velocity_rad_s=(2.0, 2.0), acceleration_rad_s2=(9.0, 9.0), effort_nm=(10.0, 10.0), tool_frame="left/tool",
        base=Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 1.0)),
    )  # fmt: skip


def joints(lift: float, *, speed: float = 0.0, torque: float = 0.0) -> JointState:
    """The first joint like that, the other at rest."""
    return JointState(
        time_s=0.0, names=("lift", "turn"), position_rad=(lift, 0.0), velocity_rad_s=(speed, 0.0),
        effort_nm=(torque, 0.0),
    )  # fmt: skip


def force(x: float, y: float = 0.0) -> Wrench:
    """An external force on the tool."""
    return Wrench(force_n=(x, y, 0.0), torque_nm=(0.0, 0.0, 0.0), frame="world")


def status(mode: ArmMode, *, allowed_n: float | None = None, error: str = "") -> ArmStatus:
    """An arm in a mode, with a threshold of its reflex."""
    settings = ControlSettings(collision_force_n=allowed_n)
    return ArmStatus(mode=mode, settings=settings, error=error, external_nm=(), wrench=force(30.0, 40.0))


GUARDED: dict[str, object] = {"force_n": 10.0}


@pytest.mark.parametrize(
    ("address", "request_", "result", "expected"),
    [
        ("left/move_until_contact", GUARDED, {"contact": True, "force_n": 12.5, "travelled_m": 0.02},
         ("contact", 12.5, 10.0, "left stopped at a contact after 20.0 mm; at rest")),
        ("left/move_until_contact", GUARDED, {"contact": False, "force_n": 0.3, "travelled_m": 0.1}, None),
        ("left/gripper/gripper_grasp", {"force_n": 30.0}, {"held": True, "force_n": 29.9, "width_m": 0.0303},
         ("grasp", 29.9, 30.0, "left/gripper holds something, 30.3 mm wide")),
        ("left/gripper/gripper_grasp", {"force_n": 30.0}, {"held": False, "force_n": 0.0, "reason": "nothing there"},
         ("grasp", 0.0, 30.0, "left/gripper holds nothing: nothing there")),
        ("left/gripper/gripper_open", {}, {"held": False, "force_n": 0.0, "width_m": 0.08}, None),
        ("left/magnet/magnet_switch", {"on": True}, {"held": True, "pull_n": 210.0, "part": "plate"},
         ("grasp", 210.0, None, "left/magnet holds plate")),
        ("left/cart_admit_dmp", {}, {"force_error_max_n": 3.0, "force_error_rms_n": 1.0},
         ("force", 3.0, None, "left pressed; its force was off by at most 3.0 N, RMS 1.0 N")),
        ("left/joint_trap_vel", {}, {"duration_s": 1.0}, None),
        ("left/move_until_contact", GUARDED, None, None),
    ],
)  # fmt: skip
def test_results_of_goals_are_marked_at_their_ends(
    address: str,
    request_: dict[str, object],
    result: Mapping[str, object] | None,
    expected: tuple[str, float, float | None, str] | None,
) -> None:
    """Only what was measured is: a free way and an open gripper are no facts of contact."""
    marks = marks_of(events_of((1.0, 2.0, address, request_, None if result is None else dict(result))))
    assert [(mark.kind, mark.value, mark.limit, mark.text) for mark in marks] == ([expected] if expected else [])
    assert [(mark.seq, mark.time_s, mark.path) for mark in marks] == [(2, 2.0, "root/step_1")] * len(marks)


def test_the_peak_of_a_guarded_move_is_marked_with_the_force_that_was_asked_for(tmp_path: Path) -> None:
    """Not a force before it, however large: nothing had been asked for then."""
    said: RecordedMessages = {
        "left/wrench": [
            (0.5, force(99.0)),
            (1.2, force(4.0)),
            (1.5, force(6.0, 8.5)),
            (1.6, force(20.0)),
            (3.0, force(0.0)),
        ]
    }
    events = events_of((1.0, 2.0, "left/move_until_contact", GUARDED, None))
    assert numbers_of(marks_of(events, tmp_path, said)) == [("force", 1.6, "root/step_1", 20.0, 10.0)]


def test_each_excursion_above_the_threshold_of_the_reflex_is_marked_once(tmp_path: Path) -> None:
    """At its peak; and the moment at which the arm stopped by itself."""
    again_s = 2.0 + 2 * APART_S
    said: RecordedMessages = {
        "left/status": [(0.0, status("moving", allowed_n=20.0)), (2.1, status("reflex", allowed_n=20.0, error="hit"))],
        "left/wrench": [(1.0, force(19.0)), (2.0, force(21.0)), (2.1, force(50.0)), (again_s, force(22.0))],
    }
    marks = marks_of(events_of((0.0, 3.0, "left/joint_trap_vel", {}, None)), tmp_path, said)
    assert numbers_of(marks) == [
        ("force", 2.1, "root/step_1", 50.0, 20.0),
        ("limit", 2.1, "root/step_1", 50.0, 20.0),
        ("force", again_s, "", 22.0, 20.0),
    ]
    assert marks[1].text == "left stopped by itself (reflex): hit"


def test_joints_are_marked_where_they_reach_their_limits(tmp_path: Path) -> None:
    """The position when it arrives there; speed and torque at their peaks; what is just below is nothing."""
    said: RecordedMessages = {
        "left/description": [(0.0, arm())],
        "left/joint_state": [
            (1.0, joints(0.98, speed=2.03, torque=9.7)),
            (2.0, joints(0.995, speed=2.0)),
            (2.5, joints(0.999)),
            (4.0, joints(-1.001)),
            (6.0, joints(0.0, speed=-2.1, torque=-9.9)),
            (6.2, joints(0.0, speed=-2.2, torque=-10.0)),
        ],
    }
    marks = marks_of([], tmp_path, said)
    assert [(mark.time_s, mark.value, mark.unit, mark.limit, mark.text) for mark in marks] == [
        (2.0, 0.999, "rad", 1.0, "left: lift at its upper limit"),
        (4.0, -1.001, "rad", -1.0, "left: lift at its lower limit"),
        (6.2, 2.2, "rad/s", 2.0, "left: lift faster than its limit"),
        (6.2, 10.0, "Nm", 10.0, "left: lift at its torque limit"),
    ]


def test_what_is_not_recorded_is_said_and_not_made_up(tmp_path: Path) -> None:
    """Without a description there are no limits; the telemetry of an active run is not read yet."""
    said: RecordedMessages = {"left/joint_state": [(1.0, joints(5.0))], "left/wrench": [(1.0, force(500.0))]}
    file = write_recording(tmp_path / "r.mcap", said)
    run = MeasuredRun()
    assert run.markers([], [file], has_ended=True).marks == ()
    assert run.markers([], [], has_ended=True).unread == NOT_RECORDED
    assert run.markers([], [file], has_ended=False).unread == STILL_ACTIVE


def test_markers_are_kept_until_the_run_or_its_recording_changes(tmp_path: Path) -> None:
    """Reading a long recording again for each look at the timeline would cost seconds."""
    events = events_of((1.0, 2.0, "left/move_until_contact", GUARDED, {"contact": True, "force_n": 11.0}))
    file = write_recording(tmp_path / "r.mcap", {"left/wrench": [(1.5, force(11.0))]})
    run = MeasuredRun()
    first = run.markers(events, [file], has_ended=True)
    assert run.markers(events, [file], has_ended=True) is first
    assert run.markers(events[:1], [file], has_ended=True).seq == 1
    file.unlink()
    write_recording(file, {"left/wrench": [(1.5, force(4.0)), (1.6, force(5.0))]})
    assert [mark.kind for mark in run.markers(events, [file], has_ended=True).marks] == ["contact"]


def test_a_real_device_is_marked_where_it_is_enabled_stopped_and_lost(tmp_path: Path) -> None:
    """How it was at the beginning is no mark."""
    ready = DeviceState(
        driver="robotiq",
        address="here:1",
        connected=True,
        enabled=True,
        mode="enabled",
        enabled_by="Anna",
        enabled_for="the area is clear",
    )
    hot = msgspec.structs.replace(ready, enabled=False, problem="too hot", fault="too hot", mode="fault")
    said: RecordedMessages = {"left/gripper/device": [(1.0, ready), (2.0, hot), (3.0, hot), (4.0, ready)]}
    marks = marks_of([], tmp_path, said)
    assert [(mark.time_s, mark.device, mark.text) for mark in marks] == [
        (2.0, "left/gripper", "left/gripper has a fault: too hot"),
        (4.0, "left/gripper", "left/gripper enabled by Anna: the area is clear"),
    ]
