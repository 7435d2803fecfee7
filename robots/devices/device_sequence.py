"""The sequence of a device to a position: interlocks, steps, and how it ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial

from engine.bus import Holder
from engine.clock import Clock
from engine.document import DevicePosition, DeviceSpec, seconds
from engine.skills.device_moves import DeviceEnd, DeviceResult
from robots.devices.device_port import DevicePort
from robots.devices.device_reading import contradiction, has_air, sensed_position

# How often sensors are read while something waits for them.
POLL_S = 0.02
# How often a sequence says where it is while a time passes.
REPORT_S = 0.1


class _EndedEarly(Exception):
    """A step found out that the position is not reached."""

    def __init__(self, ended: DeviceEnd, reason: str) -> None:
        super().__init__(reason)
        self.ended: DeviceEnd = ended
        self.reason = reason


class DeviceSequence:
    """Executes positions of one device, one at a time.

    Args:
        device: The device as written.
        port: Its outputs and sensors.
        clock: The time.
        is_at: Returns whether another device is at one of its positions.
    """

    def __init__(
        self, device: DeviceSpec, port: DevicePort, *, clock: Clock, is_at: Callable[[str, str], bool]
    ) -> None:
        self._device = device
        self._port = port
        self._clock = clock
        self._is_at = is_at

    async def execute(self, name: str, *, holder: Holder, at_step: Callable[[int, int], None]) -> DeviceResult:
        """Move to a position and say how that ended; `at_step` is called with each step and at each reading.

        `holder` is who commands it.

        Raises:
            RobotError: an output cannot be set, or a sensor cannot be read.
        """
        position = self._device.positions[name]
        before = dict(self._port.sensors)
        try:
            self._require_interlocks(name)
            self._require_air()
            report = partial(at_step, 1, len(position.steps))
            for index, step in enumerate(position.steps):
                report = partial(at_step, index + 1, len(position.steps))
                report()
                for output, on in (step.set or {}).items():
                    await self._port.set_output(output, on=on, holder=holder)
                if step.pause is not None:
                    await self._pass(seconds(step.pause), report)
                if step.wait_for is not None:
                    await self._sensors(step.wait_for, seconds(step.within), before, report)
            return await self._end(position, before, report)
        except _EndedEarly as early:
            return DeviceResult(ended=early.ended, sensed=self._sensed(), reason=early.reason)

    def _sensed(self) -> str:
        return sensed_position(self._device, self._port.sensors)

    def _require_interlocks(self, name: str) -> None:
        for lock in self._device.interlocks:
            if lock.position == name and not self._is_at(lock.device, lock.at):
                raise _EndedEarly("interlocked", f"{lock.device} is not at {lock.at}")

    def _require_air(self) -> None:
        if not has_air(self._device, self._port.sensors):
            raise _EndedEarly("no_air", f"the pressure switch {self._device.air_sensor} is off")

    async def _end(
        self, position: DevicePosition, before: Mapping[str, bool], report: Callable[[], None]
    ) -> DeviceResult:
        if position.sensors:
            await self._sensors(
                position.sensors, seconds(position.time), before, report, stable_s=seconds(position.stable)
            )
            return DeviceResult(ended="reached", sensed=self._sensed())
        await self._pass(seconds(position.time), report)
        self._require_air()
        return DeviceResult(ended="timed", sensed=self._sensed())

    async def _pass(self, duration_s: float, report: Callable[[], None]) -> None:
        """Let a time pass, and report meanwhile."""
        end_s = self._clock.now_s() + duration_s
        while (left_s := end_s - self._clock.now_s()) > 1e-9:
            await self._clock.sleep(min(left_s, REPORT_S))
            report()

    async def _sensors(
        self,
        due: Mapping[str, bool],
        within_s: float,
        before: Mapping[str, bool],
        report: Callable[[], None],
        *,
        stable_s: float = 0.0,
    ) -> None:
        """Wait until sensors have their values, and have had them for a while."""
        since_s = self._clock.now_s()
        end_s = since_s + within_s
        while True:
            sensors = self._port.sensors
            if (reason := contradiction(self._device, sensors)) != "":
                raise _EndedEarly("sensor_contradicts", reason)
            if not all(sensors[name] == on for name, on in due.items()):
                since_s = math.inf
            else:
                since_s = min(since_s, self._clock.now_s())
                if self._clock.now_s() - since_s >= stable_s - 1e-9:
                    self._require_air()
                    return
            if self._clock.now_s() >= end_s:
                break
            await self._clock.sleep(POLL_S)
            report()
        self._require_air()
        late = ", ".join(f"{name} is {'off' if on else 'on'}" for name, on in due.items() if sensors[name] != on)
        unmoved = all(sensors[name] == before[name] for name in sensors)
        where = "nothing has changed since its start" if unmoved else "it left its place"
        raise _EndedEarly("stuck", f"{late or 'the sensors changed until the end'} after {within_s:g} s; {where}")
