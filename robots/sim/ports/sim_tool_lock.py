"""The lock of a simulated tool changer: its air and its faults, and the sensors that follow the physics."""

from __future__ import annotations

from dataclasses import dataclass, field

from engine.document import ToolChangerSpec
from engine.skills.device_moves import DeviceFault
from engine.skills.switch_result import SwitchResult
from robots.sim.commands.world_commands import SwitchToolLock
from robots.sim.host.world_host import WorldHost
from robots.tool_changer.tool_lock_port import LockReading

LOCK = "lock"
"""What of a tool changer can be stuck."""


@dataclass(kw_only=True)
class SimToolLock:
    """Implements `ToolLockPort` on a simulated world; `fault` is what is wrong with it."""

    arm: str
    changer: ToolChangerSpec
    host: WorldHost
    fault: DeviceFault = field(default_factory=DeviceFault)
    output: bool | None = None
    """What was set, where a fault keeps it from the piston."""

    def switch(self, *, on: bool) -> None:
        """Turn the output on or off."""
        self.output = on
        self._press()

    def reading(self) -> LockReading:
        """Return what output and sensors say."""
        snapshot = self.host.snapshot()
        pressed, locked, present = snapshot.tool_lock(self.arm)
        fault = self.fault
        if fault.sensor == self.changer.locked:
            locked = fault.reads
        if fault.sensor == self.changer.present:
            present = fault.reads
        broken = not fault.air or bool(fault.stuck)
        on = self.output if broken and self.output is not None else pressed
        return LockReading(on=on, locked=locked, present=present, tool=snapshot.held_part(self.arm) if locked else "")

    def break_it(self, fault: DeviceFault) -> SwitchResult:
        """Set the fault of the lock; none with an empty one."""
        sensors = (self.changer.locked, self.changer.present)
        if fault.stuck not in ("", LOCK) or fault.sensor not in ("", *sensors):
            message = (
                f"{fault.stuck or fault.sensor} is not there: `stuck: {LOCK}`, or `sensor:` {' or '.join(sensors)}"
            )
            return SwitchResult(success=False, message=message)
        self.output = self.reading().on
        self.fault = fault
        self._press()
        return SwitchResult(success=True, message="without a fault" if fault == DeviceFault() else "broken")

    def _press(self) -> None:
        if self.fault.stuck or self.output is None:
            return
        if self.fault.air:
            self.host.send(SwitchToolLock(arm=self.arm, on=self.output))
        elif not self.changer.self_holding:
            self.host.send(SwitchToolLock(arm=self.arm, on=False))
