"""The causes of what a Franka robot does not do: from its modes, its errors, and the messages of libfranka."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.drivers.franka.emulation.robot_state_bytes import ERROR_NAMES
from robots.drivers.franka.franka_faults import (
    FrankaFault,
    FrankaMode,
    errors_fault,
    library_fault,
    named_errors,
    remedy,
    reported_errors,
    state_fault,
)

MESSAGES = {
    'libfranka: Move command aborted: motion aborted by reflex! ["cartesian_reflex"]': FrankaFault.REFLEX,
    'libfranka: Move command aborted: motion aborted by reflex! ["communication_constraints_violation"]': (
        FrankaFault.COMMUNICATION
    ),
    'libfranka: Move command aborted: motion aborted by reflex! ["joint_motion_generator_velocity_discontinuity", '
    '"joint_motion_generator_acceleration_discontinuity"]': FrankaFault.MOTION_LIMITS,
    'libfranka: Move command aborted: aborted by reflex! ["joint_position_motion_generator_start_pose_invalid"]': (
        FrankaFault.MOTION_LIMITS
    ),
    'libfranka: Move command aborted: motion aborted by reflex! ["power_limit_violation"]': FrankaFault.ROBOT_ERROR,
    "libfranka: Move command aborted: User Stop pressed!": FrankaFault.USER_STOP,
    "libfranka: Move command preempted!": FrankaFault.PREEMPTED,
    "libfranka: Incompatible library version (server version: 5, library version: 10).": FrankaFault.WRONG_VERSION,
    "libfranka: Connection to FCI refused.": (FrankaFault.FCI_REFUSED),
    "libfranka: Running kernel does not have realtime capabilities.": FrankaFault.NO_REAL_TIME,
    "No module named 'pylibfranka'": FrankaFault.NO_CLIENT_LIBRARY,
    "/lib/x86_64-linux-gnu/libc.so.6: version `GLIBC_2.34' not found": FrankaFault.NO_CLIENT_LIBRARY,
    "libfranka: UDP receive: Timeout": FrankaFault.CONTROLLER_SILENT,
    "libfranka: Connection timeout": FrankaFault.UNREACHABLE_CONTROLLER,
    "libfranka: TCP connection got interrupted.": FrankaFault.LINK_CUT,
    "something else": FrankaFault.REFUSED,
}


@pytest.mark.parametrize("message", MESSAGES)
def test_a_message_of_the_library_has_its_cause(message: str) -> None:
    assert library_fault(message) is MESSAGES[message]


@given(st.sets(st.sampled_from(ERROR_NAMES), min_size=1))
def test_any_errors_have_a_cause_that_names_them_and_a_remedy(errors: set[str]) -> None:
    fault = errors_fault(errors)
    assert remedy(fault)
    words = named_errors(fault, sorted(errors))
    assert words.startswith(f"{fault.value}: ")
    assert all(name in words for name in errors)
    if "joint_reflex" in errors:
        assert fault is FrankaFault.REFLEX
    # The library writes them so into its messages.
    text = "aborted [" + ", ".join(f'"{name}"' for name in sorted(errors)) + "]"
    assert reported_errors(text) == tuple(sorted(errors))


@pytest.mark.parametrize("mode", FrankaMode)
def test_only_a_robot_that_idles_or_moves_without_errors_may_move(mode: FrankaMode) -> None:
    assert (state_fault(mode, ()) is None) == (mode in {FrankaMode.IDLE, FrankaMode.MOVE})
    assert state_fault(mode, ("joint_reflex",)) is not None


@pytest.mark.parametrize("fault", FrankaFault)
def test_every_cause_but_a_plain_refusal_says_what_to_do(fault: FrankaFault) -> None:
    assert bool(remedy(fault)) == (fault is not FrankaFault.REFUSED)
