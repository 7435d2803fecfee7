"""The flags that the state packets carry: what was received, what is executed, what has ended."""

from __future__ import annotations

import math

from robots.reconcell.control_mode import ControlMode
from robots.reconcell.packet_table import PacketSpec
from robots.reconcell.packets import DirectFlags, DmpFlags, TrajectoryFlags

_CART = {ControlMode.CART_DMP, ControlMode.ADMITTANCE}


def family_of(mode: ControlMode) -> str:
    """Return the primitives that a mode executes; empty for another mode."""
    if mode is ControlMode.JOINT_DMP:
        return "joint_dmp"
    return "cart_dmp" if mode in _CART else ""


class InterfaceFlags:
    """Flags that packets raise and motions change; a pulse lasts until the next state packets have it."""

    def __init__(self) -> None:
        self.received_mode = 0
        self.error = False
        self.succeeded = False
        self._pulses: set[str] = set()
        self._finished: set[ControlMode] = set()
        self._execution: dict[str, tuple[bool, bool]] = {"joint_dmp": (False, False), "cart_dmp": (False, False)}
        self._phase = {"joint_dmp": 1.0, "cart_dmp": 1.0}
        self._family, self._a_x = "", 0.0

    def receive(self, spec: PacketSpec) -> None:
        """Raise the pulses of a packet."""
        self._pulses |= {"any", spec.family or str(spec.port)}
        if spec.port == 27000 and not spec.family:
            self._pulses.add("line")

    def execution(self, family: str, *, execute: bool, reset: bool) -> None:
        """Keep the execution flags of a primitive; a reset sets its phase back."""
        self._execution[family] = (execute, reset)
        if reset:
            self._phase[family] = 1.0

    def start(self, mode: ControlMode, *, a_x: float = 0.0) -> None:
        """Reset the flags for a motion that was sent to the arm."""
        self.error = self.succeeded = False
        self._finished.discard(mode)
        self._family, self._a_x = family_of(mode), a_x
        if self._family:
            self._phase[self._family] = 1.0

    def follow(self, progress: float) -> None:
        """Keep the phase of the primitive under way."""
        if self._family:
            self._phase[self._family] = math.exp(-self._a_x * progress)

    def end(self, mode: ControlMode, *, succeeded: bool, failed: bool) -> None:
        """Keep how a motion has ended."""
        family = family_of(mode)
        if succeeded:
            self._finished.add(mode)
            if family:
                self._phase[family] = math.exp(-self._a_x)
        self.succeeded, self.error = succeeded, failed and not succeeded
        if family:
            self._execution[family] = (False, self._execution[family][1])

    def take_pulses(self) -> set[str]:
        """Return the pulses since the last call, and end them."""
        pulses, self._pulses = self._pulses, set()
        return pulses

    def direct(self, pulses: set[str]) -> DirectFlags:
        """Return the flags of direct control."""
        return DirectFlags(received=int("20000" in pulses))

    def trapezoid(self, pulses: set[str]) -> TrajectoryFlags:
        """Return the flags of trapezoidal motions."""
        return TrajectoryFlags(
            received=int("26000" in pulses), finished=self._has_finished(ControlMode.JOINT_TRAPEZOID)
        )

    def line(self, pulses: set[str]) -> TrajectoryFlags:
        """Return the flags of lines."""
        return TrajectoryFlags(received=int("line" in pulses), finished=self._has_finished(ControlMode.CART_LINE))

    def primitive(self, family: str, pulses: set[str], *, loaded_id: int) -> DmpFlags:
        """Return the flags of primitives."""
        execute, reset = self._execution[family]
        modes = (ControlMode.JOINT_DMP,) if family == "joint_dmp" else tuple(_CART)
        return DmpFlags(
            received=float(family in pulses),
            loaded_id=float(loaded_id),
            execute=float(execute),
            reset=float(reset),
            phase=self._phase[family],
            finished=float(any(self._has_finished(mode) for mode in modes)),
        )

    def _has_finished(self, mode: ControlMode) -> int:
        return int(mode in self._finished)
