"""Safety bits, words of the dashboard and messages of the client library have one cause each."""

from __future__ import annotations

import pytest

from robots.drivers.universal_robots.ur_faults import UrFault, dashboard_fault, library_fault, safety_fault


@pytest.mark.parametrize(
    ("bits", "mode", "fault"),
    [
        ((0,), 7, None),
        ((0, 1), 7, None),
        ((0,), 5, UrFault.POWER_OFF),
        ((2, 10), 7, UrFault.PROTECTIVE_STOP),
        ((4, 10), 7, UrFault.SAFEGUARD_STOP),
        ((5, 7, 10), 3, UrFault.EMERGENCY_STOP),
        ((6, 7, 10), 3, UrFault.EMERGENCY_STOP),
        ((8,), 3, UrFault.SAFETY_VIOLATION),
        ((9,), 3, UrFault.SAFETY_FAULT),
    ],
)
def test_safety_bits_have_a_cause(bits: tuple[int, ...], mode: int, fault: UrFault | None) -> None:
    """The gravest of those that are set."""
    assert safety_fault(sum(1 << bit for bit in bits), mode) is fault


@pytest.mark.parametrize(
    ("answer", "fault"),
    [
        ("Safetystatus: NORMAL", None),
        ("Safetystatus: PROTECTIVE_STOP", UrFault.PROTECTIVE_STOP),
        ("Safetystatus: ROBOT_EMERGENCY_STOP", UrFault.EMERGENCY_STOP),
        ("", None),
    ],
)
def test_an_answer_of_the_dashboard_has_a_cause(answer: str, fault: UrFault | None) -> None:
    """None where it has no answer."""
    assert dashboard_fault(answer) is fault


@pytest.mark.parametrize(
    ("message", "fault"),
    [
        ("One of the RTDE input registers are already in use! Currently", UrFault.IN_USE),
        ("ur_rtde: Please enable remote control on the robot!", UrFault.LOCAL_CONTROL),
        ("Error: Could not connect to: 10.0.0.1 at 30004, verify the IP", UrFault.UNREACHABLE_CONTROLLER),
        ("No module named 'rtde_receive'", UrFault.NO_CLIENT_LIBRARY),
        ("setTcp was refused", UrFault.REFUSED),
    ],
)
def test_a_message_of_the_library_has_a_cause(message: str, fault: UrFault) -> None:
    """By its words: it has no codes."""
    assert library_fault(message) is fault
