"""The connection to an ABB controller that follows set points: its process moves it, Robot Web Services name causes."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

from msgspec.structs import replace

from engine.cell.drivers import DeviceReport
from engine.errors import RobotError
from robots.drivers.abb.abb_faults import REMEDIES
from robots.drivers.abb.gripper_switch import GripperSwitch
from robots.drivers.abb.rws.rws_inputs import rws_inputs
from robots.drivers.abb.rws.rws_monitor import RwsMonitor
from robots.drivers.arm.arm_connection import ControllerFacts
from robots.drivers.arm.controller_loop import NOT_ENABLED
from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.port import ArmPort, InputPort, OutputPort

_log = logging.getLogger("flexcell.devices")


class EgmArmConnection:
    """Implements `robots.drivers.arm.arm_connection.ArmConnection`.

    Args:
        name: The arm, for messages.
        process: Measures and commands the arm.
        rws: Robot Web Services, not yet connected; None without them.
        switch: The gripper, not yet connected; None without one.
    """

    def __init__(
        self, name: str, process: ProcessArmConnection, *, rws: RwsMonitor | None, switch: GripperSwitch | None
    ) -> None:
        self._name = name
        self._process = process
        self._rws = rws
        self._switch = switch
        self._changed: Callable[[], None] = lambda: None
        self._was_permitted = False
        process.when_changed(self._on_change)
        if rws is not None:
            rws.when_changed(self._on_change)
        self._inputs = rws_inputs(rws, lost_reason=lambda: self.lost_reason)

    @property
    def port(self) -> ArmPort:
        """Measures and commands the arm."""
        return self._process.port

    @property
    def outputs(self) -> OutputPort | None:
        """The gripper switch as output 0; None where the options have none."""
        return self._switch

    @property
    def inputs(self) -> InputPort | None:
        """The signals of `rws.inputs`; None without any."""
        return self._inputs

    @property
    def problem(self) -> str:
        """Why the arm may not move at present; as Robot Web Services name it, where they know the cause."""
        problem, cause = self._process.problem, self._cause
        if not problem or self._process.lost_reason or problem == NOT_ENABLED or not cause:
            return problem
        return cause

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected."""
        return self._process.lost_reason

    @property
    def process_id(self) -> int:
        """The id of the control process, 0 while there is none."""
        return self._process.process_id

    def facts(self) -> ControllerFacts:
        """Return what the controller says of itself."""
        facts, rws = self._process.facts(), self._rws
        if rws is None:
            return facts
        safety = f"{facts.safety} (RWS is lost: {rws.lost_reason})" if rws.lost_reason else facts.safety
        fault = rws.fault
        if fault is not None:
            safety = f"{fault[0].value}: {fault[1]}"
        return ControllerFacts(
            readings=facts.readings,
            age_s=facts.age_s,
            firmware=rws.firmware,
            safety=safety,
            speed_scaling=facts.speed_scaling,
        )

    def when_changed(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when `problem`, `lost_reason` or `safety` of the facts changes."""
        self._changed = callback

    async def open(self) -> None:
        """Connect and return with the first measurement; commands nothing."""
        await self._process.open()
        try:
            if self._rws is not None:
                await self._rws.open()
        except BaseException:
            # Also when it is cancelled while connecting: the process must not outlive this call.
            await self._process.close()
            raise

    async def enable(self) -> None:
        """Recover the controller where Robot Web Services can, connect the gripper, and permit motion."""
        if self._process.lost_reason:
            raise RobotError(self._process.lost_reason, where=self._name)
        rws = self._rws if self._rws is not None and not self._rws.lost_reason else None
        if rws is not None:
            await rws.require_recoverable()
            await rws.recover()
        if self._switch is not None:
            await asyncio.to_thread(self._switch.connect)
        await self._process.enable()
        self._was_permitted = True
        self._changed()

    async def report(self, *, readings: int) -> DeviceReport:
        """Read this many times and return what the controller says."""
        report, rws = await self._process.report(readings=readings), self._rws
        state = rws.state if rws is not None else None
        if rws is None or state is None:
            return report
        state_text = f"{report.state}; {state.mode} mode, {state.panel}, RAPID {state.execution}"
        fault = f"{rws.fault[0].value}: {rws.fault[1]}" if rws.fault is not None else report.fault
        readings_now = {**report.readings, "speed_ratio": state.speed_share}
        return replace(
            report,
            state=state_text,
            fault=fault,
            firmware=rws.firmware,
            readings=readings_now,
            inputs=rws.input_values,
        )

    async def close(self) -> None:
        """Bring the arm to rest and disconnect."""
        try:
            await self._process.close()
        finally:
            if self._rws is not None:
                await self._rws.close()
            if self._switch is not None:
                self._switch.close("disconnected")

    @property
    def _cause(self) -> str:
        fault = self._rws.fault if self._rws is not None else None
        return f"{fault[0].value}: {fault[1]} ({REMEDIES[fault[0]]}, then enable motion)" if fault is not None else ""

    def _on_change(self) -> None:
        problem = self._process.problem
        if problem and self._was_permitted:
            self._was_permitted = False
            _log.error("%s may not move: %s", self._name, problem)
            if self._switch is not None:
                self._switch.close(f"{problem}, and motion was not enabled since")
            if self._rws is not None:
                self._rws.read_now()
        self._changed()
