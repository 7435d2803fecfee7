"""Skill server of one device of a cell, over a port: simulated, or with pins behind it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import msgspec

from engine.bus import ActiveGoal, SkillBus, Topic
from engine.clock import Clock
from engine.document import DeviceSpec
from engine.errors import GoalRejected, RobotError, SkillFailed
from engine.skills.device_moves import DeviceFeedback, DeviceReading, DeviceResult, MoveDevice, ReadDevice
from engine.wording import did_you_mean
from robots.devices.device_port import DevicePort
from robots.devices.device_reading import contradiction, has_air, is_at, sensed_position
from robots.devices.device_sequence import DeviceSequence


class DeviceMemo(msgspec.Struct, frozen=True, kw_only=True):
    """What a device remembers: the commanded position, and whether its time has passed."""

    commanded: str = ""
    timed: bool = False


class DeviceServer:
    """Serves a device under its name.

    Args:
        name: Its name in the cell, and on the bus.
        device: The device as written.
        port: Its outputs and sensors.
        clock: The time.
        is_at: Returns whether another device is at one of its positions.
        moved: Called while axes may have moved, and when they rest.
    """

    def __init__(
        self,
        name: str,
        device: DeviceSpec,
        port: DevicePort,
        *,
        clock: Clock,
        is_at: Callable[[str, str], bool],
        moved: Callable[[], None] = lambda: None,
    ) -> None:
        self.name = name
        self.memo = DeviceMemo()
        self._device = device
        self._port = port
        self._moved = moved
        self._sequence = DeviceSequence(device, port, clock=clock, is_at=is_at)
        self._moving: asyncio.Task[DeviceResult] | None = None
        self._topic: Topic[DeviceReading] | None = None

    @property
    def moving(self) -> bool:
        """True while a sequence is executed."""
        return self._moving is not None

    def state(self) -> DeviceReading:
        """Return what is known of the device."""
        try:
            sensors, outputs = dict(self._port.sensors), dict(self._port.outputs)
        except RobotError as error:
            return DeviceReading(commanded=self.memo.commanded, moving=self.moving, problem=error.message)
        problem = contradiction(self._device, sensors)
        if not has_air(self._device, sensors):
            problem = f"no air: {self._device.air_sensor} is off"
        return DeviceReading(
            commanded=self.memo.commanded,
            sensed=sensed_position(self._device, sensors),
            moving=self.moving,
            timed=self.memo.timed,
            outputs=outputs,
            sensors=sensors,
            axes=dict(self._port.axes),
            problem=problem,
        )

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills and publish the state."""
        bus.advertise_action(MoveDevice, self._move, namespace=self.name, exclusive=self.name)
        bus.advertise_service(ReadDevice, self._read, namespace=self.name)
        self._topic = bus.topic(f"{self.name}/state", DeviceReading)
        self._topic.provide(self.state)

    def publish(self) -> None:
        """Publish the state to subscribers."""
        if self._topic is not None and self._topic.subscriber_count:
            self._topic.publish(self.state())

    async def stop(self) -> None:
        """End the sequence; the outputs keep their values, so that what is held stays held."""
        if self._moving is not None:
            self._moving.cancel()
            await asyncio.wait([self._moving])

    async def _move(self, goal: MoveDevice, handle: ActiveGoal[DeviceFeedback]) -> DeviceResult:
        if goal.position not in self._device.positions:
            hint = did_you_mean(goal.position, self._device.positions)
            raise GoalRejected(f"{self.name} has no position {goal.position}", where=handle.address, hint=hint)
        handle.accept()

        def at_step(step: int, steps: int) -> None:
            handle.feedback(DeviceFeedback(step=step, steps=steps, axes=dict(self._port.axes)))
            self._moved()
            self.publish()

        self.memo = DeviceMemo(commanded=goal.position)
        sequence = self._sequence.execute(goal.position, holder=handle.holder, at_step=at_step)
        task = asyncio.create_task(sequence, name=f"move {self.name}")
        self._moving = task
        handle.on_cancel(lambda: _cancel(task))
        try:
            result = await task
        except asyncio.CancelledError:
            if handle.cancel_requested:
                return DeviceResult(ended="canceled", sensed=self.state().sensed, reason="canceled")
            if task.cancelled():
                raise SkillFailed(f"{self.name} was stopped", where=handle.address) from None
            raise
        except RobotError as error:
            raise SkillFailed(f"{self.name} did not move to {goal.position}", where=handle.address) from error
        finally:
            task.cancel()
            self._moving = None
            self._moved()
            self.publish()
        self.memo = DeviceMemo(commanded=goal.position, timed=result.ended in ("reached", "timed"))
        self.publish()
        return result

    async def _read(self, _request: ReadDevice) -> DeviceReading:
        return self.state()


def _cancel(task: asyncio.Task[DeviceResult]) -> None:
    task.cancel()


def known_at(bus: SkillBus, name: str, device: DeviceSpec, position: str) -> bool:
    """Return whether a device is at a position, by what it says on the bus."""
    reading = bus.topic(f"{name}/state", DeviceReading).latest
    return reading is not None and is_at(device, reading, position)
