"""Supervises the process that owns the client library: typed failures, two paths to stop, and reading after a loss."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from types import TracebackType
from typing import Self

from engine.errors import RobotError
from robots.drivers.universal_robots.ur_faults import (
    UrFault,
    UrFaultError,
    dashboard_fault,
    library_fault,
    safety_fault,
)
from robots.drivers.universal_robots.ur_messages import (
    ConnectController,
    ControllerConnected,
    ControllerHeartbeat,
    EnableMotion,
    FromUrProcess,
    LibraryFailure,
    LinkLost,
    MotionEnabled,
    MoveJointsRequest,
    SixNumbers,
    StopMotion,
    ToUrProcess,
    UrMotionReport,
)
from robots.io.worker_process import WorkerProcess

DASHBOARD_PORT = 29999
_CODE = "from robots.drivers.universal_robots.ur_process_main import main; main()"
SILENCE_S = 0.35
"""Without a heartbeat, or with heartbeats that repeat the time of the controller, for so long: lost."""
_REPLY_LIMIT_S = 10.0
_DASHBOARD_LIMIT_S = 1.0
_RETRY_S = 0.5

FaultHandler = Callable[[UrFault], None]


class UrSupervisor:
    """One controller, read as long as it can be; it moves only after `enable_motion`, and not after a loss.

    Args:
        host: The address of the controller.
        silence_s: How long process and controller may be silent.
        on_fault: Called when the link or the process is lost.
    """

    def __init__(
        self, host: str, *, silence_s: float = SILENCE_S, on_fault: FaultHandler = lambda _fault: None
    ) -> None:
        self._host = host
        self._silence_s = silence_s
        self._patience_s = silence_s
        self._on_fault = on_fault
        self._process: WorkerProcess[ToUrProcess, FromUrProcess] | None = None
        self._fault: UrFault | None = None
        self._fresh_at_s = 0.0
        self._silence: asyncio.TimerHandle | None = None
        self._is_enabled = False
        self._recovery: asyncio.Task[None] | None = None
        self._closing = asyncio.Event()
        self.readings = asyncio.Condition()
        """Notified at every heartbeat and at every loss."""
        self.latest: ControllerHeartbeat | None = None
        """The latest measurement; None while nothing is read."""

    async def __aenter__(self) -> Self:
        """Read the controller; raises UrFaultError."""
        await self._connect()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """End the process; the watchdog stops a motion under way."""
        self._closing.set()
        if self._recovery is not None:
            await self._recovery
        self._end_process("closed")

    @property
    def is_motion_enabled(self) -> bool:
        """Whether motions are accepted."""
        return self._is_enabled

    @property
    def process_id(self) -> int:
        """The id of the process, 0 while there is none."""
        return self._process.pid if self._process is not None else 0

    async def enable_motion(self, request: EnableMotion) -> None:
        """Upload the script, arm the watchdog, set tool and payload; motions are accepted then. Raises UrFaultError."""
        self._require_safe()
        # The library waits up to seconds, and holds back the heartbeats meanwhile.
        self._be_patient(_REPLY_LIMIT_S)
        try:
            answer = await self._ask(request)
        finally:
            self._be_patient(self._silence_s)
        if not isinstance(answer, MotionEnabled):
            # The latest heartbeat may be older than the stop that is the cause.
            fault = dashboard_fault(await self._dashboard("safetystatus"))
            raise self._error(fault, "the controller cannot move") if fault is not None else self._refusal(answer)
        self._is_enabled = True

    async def move_joints(self, q_rad: SixNumbers, *, speed_rad_s: float, acceleration_rad_s2: float) -> None:
        """Move and return at rest at the target; raises UrFaultError with the cause where it is not reached."""
        if not self._is_enabled:
            raise self._error(UrFault.NOT_ENABLED, "no motion is accepted")
        self._require_safe()
        report = await self._ask(
            MoveJointsRequest(q_rad=q_rad, speed_rad_s=speed_rad_s, acceleration_rad_s2=acceleration_rad_s2)
        )
        if not isinstance(report, UrMotionReport):
            raise self._refusal(report)
        if not report.is_reached:
            raise await self._cause(report)

    def stop(self, *, deceleration_rad_s2: float = 4.0) -> None:
        """Bring the arm to rest on its path; `move_joints` then raises the fault `STOPPED`."""
        with suppress(RobotError):
            self._live().send(StopMotion(deceleration_rad_s2=deceleration_rad_s2))

    async def hard_stop(self) -> str:
        """End the program by the dashboard, on a connection of its own; returns its answer, empty where it has none."""
        return await self._dashboard("stop")

    async def _connect(self) -> None:
        self._fault = None
        process = WorkerProcess[ToUrProcess, FromUrProcess](
            _CODE,
            FromUrProcess,
            what=f"the process of the controller {self._host}",
            hint="only reading is restored by itself",
            on_notice=self._notice,
            on_lost=lambda _reason: self._handle_loss(process),
        )
        self._process = process
        await process.start()
        answer = await self._ask(ConnectController(host=self._host))
        if not isinstance(answer, ControllerConnected):
            self._end_process("it cannot read the controller")
            raise self._refusal(answer)
        self._be_patient(self._silence_s)
        async with self.readings:
            await self.readings.wait_for(lambda: self.latest is not None or self._fault is not None)
        if self._fault is not None:
            raise self._error(self._fault, "lost while connecting")

    async def _ask(self, request: ToUrProcess) -> FromUrProcess:
        """Return the answer to a request; raises UrFaultError when the process is lost meanwhile."""
        try:
            return await self._live().ask(request).answer
        except RobotError as error:
            raise self._error(self._fault or UrFault.PROCESS_ENDED, error.message) from error

    def _live(self) -> WorkerProcess[ToUrProcess, FromUrProcess]:
        if self._process is None:
            raise self._error(self._fault or UrFault.PROCESS_ENDED, "the controller is not read at present")
        return self._process

    def _notice(self, message: FromUrProcess) -> None:
        match message:
            case ControllerHeartbeat():
                now_s = asyncio.get_running_loop().time()
                if message.is_fresh:
                    self._fresh_at_s = now_s
                elif now_s - self._fresh_at_s > self._patience_s:
                    self._lose(UrFault.CONTROLLER_SILENT, "its time does not advance")
                    return
                self.latest = message
                self._arm_silence()
                self._notify()
            case LinkLost():
                self._lose(UrFault.LINK_CUT, "the library has lost the controller")
            case _:
                pass

    def _be_patient(self, limit_s: float) -> None:
        """Let process and controller be silent for so long from now on."""
        if self._fault is None:
            self._patience_s = limit_s
            self._fresh_at_s = asyncio.get_running_loop().time()
            self._arm_silence()

    def _arm_silence(self) -> None:
        if self._silence is not None:
            self._silence.cancel()
        reason = f"no heartbeat for {self._patience_s:g} s"
        loop = asyncio.get_running_loop()
        self._silence = loop.call_later(self._patience_s, self._lose, UrFault.PROCESS_SILENT, reason)

    def _lose(self, fault: UrFault, reason: str) -> None:
        """Give up the process: nothing that it says counts any more."""
        if self._fault is None and self._process is not None:
            self._fault = fault
            self._process.kill(reason)

    def _handle_loss(self, process: WorkerProcess[ToUrProcess, FromUrProcess]) -> None:
        """Report that the process is gone, by itself or by `_lose`; called once for each process."""
        if self._closing.is_set() or process is not self._process:
            return
        if self._silence is not None:
            self._silence.cancel()
        was_read, self.latest = self.latest is not None, None
        self._fault = self._fault or UrFault.PROCESS_ENDED
        was_enabled, self._is_enabled = self._is_enabled, False
        self._notify()
        if was_read:
            self._on_fault(self._fault)
            self._recovery = asyncio.create_task(self._recover(stop_first=was_enabled))

    async def _recover(self, *, stop_first: bool) -> None:
        """End a motion by the second path, then read again as soon as that is possible; motion stays disabled."""
        if stop_first:
            await self.hard_stop()
        while not self._closing.is_set():
            self._end_process("it is replaced")
            attempt = asyncio.create_task(self._connect())
            closing = asyncio.create_task(self._closing.wait())
            await asyncio.wait({attempt, closing}, return_when=asyncio.FIRST_COMPLETED)
            closing.cancel()
            if not attempt.done():
                attempt.cancel()
            with suppress(RobotError, asyncio.CancelledError):
                await attempt
                return
            with suppress(TimeoutError):
                await asyncio.wait_for(self._closing.wait(), _RETRY_S)

    def _end_process(self, reason: str) -> None:
        process, self._process = self._process, None
        if self._silence is not None:
            self._silence.cancel()
        if process is not None:
            process.end_reason = process.end_reason or reason
            process.end()

    def _notify(self) -> None:
        async def notify() -> None:
            async with self.readings:
                self.readings.notify_all()

        self._notifying = asyncio.get_running_loop().create_task(notify())

    def _require_safe(self) -> None:
        if self.latest is None:
            raise self._error(self._fault or UrFault.PROCESS_ENDED, "the controller is not read at present")
        fault = safety_fault(self.latest.safety_bits, self.latest.robot_mode)
        if fault is not None:
            raise self._error(fault, "the controller cannot move")

    async def _cause(self, report: UrMotionReport) -> UrFaultError:
        """Return why a motion has ended before its target."""
        fault = safety_fault(report.safety_bits, report.robot_mode)
        fault = fault or dashboard_fault(await self._dashboard("safetystatus"))
        if fault is None and report.is_stopped:
            return self._error(UrFault.STOPPED, "the motion was stopped on its path")
        if fault is None and not report.is_program_running:
            fault = UrFault.PROGRAM_ENDED
        if fault is not None:
            # A stop ends the program too: it has to be started again before the next motion.
            self._is_enabled = False
        return self._error(fault or UrFault.REFUSED, "the motion has not reached its target")

    async def _dashboard(self, command: str) -> str:
        try:
            async with asyncio.timeout(_DASHBOARD_LIMIT_S):
                reader, writer = await asyncio.open_connection(self._host, DASHBOARD_PORT)
                try:
                    await reader.readline()
                    writer.write(f"{command}\n".encode())
                    return (await reader.readline()).decode("utf-8", "replace").strip()
                finally:
                    writer.close()
        except (OSError, TimeoutError, ValueError):
            return ""

    def _refusal(self, answer: FromUrProcess) -> UrFaultError:
        message = answer.message if isinstance(answer, LibraryFailure) else f"unexpected answer {type(answer).__name__}"
        return self._error(library_fault(message), message)

    def _error(self, fault: UrFault, message: str) -> UrFaultError:
        return UrFaultError(fault, message, where=self._host)
