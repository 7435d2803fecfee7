"""The flags of the state packets: pulses of what was received, phase and end of what is executed."""

from __future__ import annotations

import math

from robots.reconcell import ControlMode
from robots.reconcell.interface_flags import InterfaceFlags
from robots.reconcell.packet_table import PacketSpec, specs_of
from robots.reconcell.packets import DirectFlags, DmpFlags, TrajectoryFlags


def spec(port: int, index: int = 0) -> PacketSpec:
    return specs_of(port, "command")[index]


def test_a_pulse_is_in_the_next_packets_only_and_of_its_kind() -> None:
    flags = InterfaceFlags()
    flags.receive(spec(26000))
    flags.receive(spec(27000, 0))
    pulses = flags.take_pulses()
    assert "any" in pulses
    assert flags.trapezoid(pulses) == TrajectoryFlags(received=1, finished=0)
    assert flags.line(pulses) == TrajectoryFlags(received=1, finished=0)
    assert flags.direct(pulses) == DirectFlags(received=0)
    assert flags.take_pulses() == set()
    # The other packet of port 27000 is no line.
    flags.receive(spec(27000, 1))
    flags.receive(spec(20000))
    pulses = flags.take_pulses()
    assert flags.line(pulses).received == 0
    assert flags.direct(pulses) == DirectFlags(received=1)


def test_the_phase_of_a_primitive_falls_from_one_and_a_reset_sets_it_back() -> None:
    flags = InterfaceFlags()
    flags.receive(spec(25103))
    flags.execution("joint_dmp", execute=True, reset=False)
    flags.start(ControlMode.JOINT_DMP, a_x=2.0)
    flags.follow(0.5)
    shown = flags.primitive("joint_dmp", flags.take_pulses(), loaded_id=3)
    assert shown == DmpFlags(received=1.0, loaded_id=3.0, execute=1.0, reset=0.0, phase=math.exp(-1.0), finished=0.0)
    assert flags.primitive("cart_dmp", set(), loaded_id=0).phase == 1.0
    flags.end(ControlMode.JOINT_DMP, succeeded=True, failed=False)
    shown = flags.primitive("joint_dmp", set(), loaded_id=3)
    assert (shown.finished, shown.execute, shown.phase) == (1.0, 0.0, math.exp(-2.0))
    flags.execution("joint_dmp", execute=False, reset=True)
    shown = flags.primitive("joint_dmp", set(), loaded_id=3)
    assert (shown.reset, shown.phase) == (1.0, 1.0)


def test_a_failed_motion_is_an_error_until_the_next_one_and_a_stopped_one_is_none() -> None:
    flags = InterfaceFlags()
    flags.start(ControlMode.CART_LINE)
    flags.end(ControlMode.CART_LINE, succeeded=False, failed=True)
    assert (flags.error, flags.succeeded, flags.line(set()).finished) == (True, False, 0)
    flags.start(ControlMode.CART_LINE)
    assert not flags.error
    flags.end(ControlMode.CART_LINE, succeeded=False, failed=False)
    assert (flags.error, flags.succeeded) == (False, False)
