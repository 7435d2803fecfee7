"""Skill calls of one arm on behalf of the commander: one motion at a time, under the same checks as any skill."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine
from typing import Any, Literal

from engine.bus import GoalEnd, GoalHandle, GoalStatus, Holder, SkillBus
from engine.cause_chain import describe_cause
from engine.errors import FlexcellError, LeaseRefused, NoSuchSkill
from engine.skill import Action, Service
from engine.skills.arm_control import ArmStatus
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.switch_result import SwitchResult
from robots.reconcell.control_mode import ControlMode
from robots.reconcell.packet_errors import PacketRefused

_log = logging.getLogger("flexcell.reconcell")

Refuse = Callable[[PacketRefused], None]
Ended = Callable[[ControlMode, GoalStatus], None]


class ArmCommands:
    """The motion under way, and the requests to the arm that are not answered yet.

    The arm is leased while it is commanded, so that no run starts to move it, and given back at rest.

    Args:
        bus: The bus of the cell.
        arm: Bus name of the arm.
        refuse: Receives what turns out to be refused only after the packet was taken.
        ended: Receives each motion that has ended, with its status.
        watchdog_s: Longest time between two set points of direct control.
        is_stopped: Whether the cell is stopped until an operator releases it.
    """

    def __init__(
        self,
        bus: SkillBus,
        arm: str,
        *,
        refuse: Refuse,
        ended: Ended,
        watchdog_s: float,
        is_stopped: Callable[[], bool],
    ) -> None:
        self._bus = bus
        self._arm = arm
        self._refuse = refuse
        self._ended = ended
        self._watchdog_s = watchdog_s
        self._is_stopped = is_stopped
        self._holder = Holder(f"reconcell of {arm}")
        self._goal: GoalHandle[Any, Any] | None = None
        self._set_points = bus.topic(f"{arm}/direct_joints", JointCommand)
        self._tasks: set[asyncio.Task[None]] = set()
        self._direct: Literal["off", "starting", "on", "ending"] = "off"
        self._set_point: tuple[float, ...] = ()
        self._stopped = False
        self._changing = False
        self.mode = ControlMode.STOP
        """The mode of the motion under way; STOP for none."""

    @property
    def moving(self) -> bool:
        """Whether the commander has a motion under way."""
        return self.mode is not ControlMode.STOP

    @property
    def ending(self) -> bool:
        """Whether the motion under way is coming to rest."""
        if self._goal is not None:
            return self._goal.status is GoalStatus.CANCELING
        return self._direct == "ending"

    @property
    def progress(self) -> float:
        """The share of the motion under way that is done; 0 where it says none."""
        feedback = self._goal.feedback if self._goal is not None else None
        return float(getattr(feedback, "progress", 0.0))

    def start(self, mode: ControlMode, goal: Action[Any, Any]) -> None:
        """Send a goal.

        Raises:
            PacketRefused: a motion is under way, a run leases the arm, or the arm has no such skill.
        """
        self._require_free()
        try:
            handle = self._bus.send_goal(goal, to=self._arm, holder=self._holder)
        except LeaseRefused as error:
            raise PacketRefused("leased", error.message, where=self._arm, hint=error.hint) from error
        except NoSuchSkill as error:
            raise PacketRefused("not supported", str(error), where=self._arm) from error
        self.mode, self._goal = mode, handle
        self._spawn(self._await_end(mode, handle), f"{mode.name} of {self._arm}")

    def start_direct(self, joints: tuple[float, ...]) -> None:
        """Turn direct control on and send its first set point; raises as `start` does."""
        self._require_free()
        try:
            self._bus.leases.acquire((self._arm,), self._holder)
        except LeaseRefused as error:
            raise PacketRefused("leased", error.message, where=self._arm, hint=error.hint) from error
        self.mode, self._direct, self._set_point = ControlMode.DIRECT, "starting", joints
        self._spawn(self._turn_on(), f"direct control of {self._arm}")

    def send_direct(self, joints: tuple[float, ...]) -> None:
        """Send a set point; raises PacketRefused where the arm takes none."""
        self._require_direct()
        if self._direct == "starting":
            self._set_point = joints
        elif self._direct == "on":
            self._set_points.publish(JointCommand(position_rad=joints))
        else:
            raise PacketRefused("direct control is off", "the arm takes no set points", hint="select mode 4 first")

    def check(self) -> None:
        """Notice that the arm has left direct control by itself or by a STOP."""
        try:
            self._require_direct()
        except PacketRefused as refusal:
            self._refuse(refusal)

    def hold(self, *, stopped: bool) -> None:
        """Hold the motion under way, or let it go on; raises PacketRefused where there is none."""
        if self._goal is None:
            raise PacketRefused("no data", "no primitive is executed")
        self._stopped = stopped
        if not self._changing:
            self._spawn(self._change_hold(self._goal), f"phase of {self._arm}")

    def stop(self) -> None:
        """Bring the motion under way to rest."""
        if self._goal is not None:
            self._goal.cancel()
        elif self._direct in {"starting", "on"}:
            self._direct = "ending"
            self._spawn(self._turn_off(), f"end of direct control of {self._arm}")

    def call(self, *requests: Service[Any]) -> None:
        """Call services of the arm, one after the other until one is refused; a refusal is reported."""
        self._require_released()
        self._spawn(self._call(requests), f"{requests[0].skill_name()} of {self._arm}")

    async def close(self) -> None:
        """Bring the arm to rest and return when nothing is under way."""
        self.stop()
        while self._tasks:
            await asyncio.wait(tuple(self._tasks))

    def _require_released(self) -> None:
        if self._is_stopped():
            raise PacketRefused("cell is stopped", "it is not released", hint="flexcell stop --release")

    def _require_free(self) -> None:
        self._require_released()
        if self.moving:
            raise PacketRefused(
                "busy", f"{self.mode.name} is under way", where=self._arm, hint=f"end it by mode {ControlMode.STOP}"
            )

    def _require_direct(self) -> None:
        """Raise PacketRefused, once, where direct control was on and the arm has left it."""
        status = self._bus.topic(f"{self._arm}/status", ArmStatus).latest
        if self._direct == "on" and (status is None or status.mode != "direct"):
            self._free(ControlMode.DIRECT, GoalStatus.ABORTED)
            raise PacketRefused(
                "direct control is off", "the arm has left it", where=self._arm, hint="select mode 4 again"
            )

    async def _await_end(self, mode: ControlMode, handle: GoalHandle[Any, Any]) -> None:
        end: GoalEnd[Any] = await handle.result()
        self._goal, self._stopped = None, False
        if end.status in {GoalStatus.REJECTED, GoalStatus.ABORTED}:
            reason = describe_cause(end.cause) if end.cause is not None else "no reason given"
            name = "rejected by the arm" if end.status is GoalStatus.REJECTED else "failed"
            self._refuse(PacketRefused(name, reason, where=self._arm))
        self._free(mode, end.status)

    async def _turn_on(self) -> None:
        result = await self._switched(SwitchDirectControl(on=True, watchdog_s=self._watchdog_s))
        if self._direct != "starting":
            return  # its end is on its way
        if result is None or not result.success:
            self._free(ControlMode.DIRECT, GoalStatus.REJECTED)
            return
        self._direct = "on"
        try:
            self.send_direct(self._set_point)
        except PacketRefused as refusal:
            self._refuse(refusal)

    async def _turn_off(self) -> None:
        result = await self._switched(SwitchDirectControl(on=False))
        done = result is not None and result.success
        self._free(ControlMode.DIRECT, GoalStatus.SUCCEEDED if done else GoalStatus.ABORTED)

    async def _switched(self, request: SwitchDirectControl) -> SwitchResult | None:
        try:
            result = await self._bus.call(request, to=self._arm, holder=self._holder)
        except FlexcellError as error:
            self._refuse(PacketRefused(_name_of(error), str(error), where=self._arm))
            return None
        if not result.success:
            self._refuse(PacketRefused("rejected by the arm", result.message, where=self._arm))
        return result

    async def _change_hold(self, goal: GoalHandle[Any, Any]) -> None:
        self._changing, stopped = True, not self._stopped
        try:
            # Flags that arrive meanwhile change what is wanted.
            while stopped is not self._stopped and not goal.finished:
                stopped = self._stopped
                await (goal.hold() if stopped else goal.resume())
        except FlexcellError as error:
            self._refuse(PacketRefused("not supported", str(error), where=self._arm))
        finally:
            self._changing = False

    async def _call(self, requests: tuple[Service[Any], ...]) -> None:
        for request in requests:
            try:
                result = await self._bus.call(request, to=self._arm, holder=self._holder)
            except FlexcellError as error:
                self._refuse(PacketRefused(_name_of(error), str(error), where=self._arm))
                return
            if isinstance(result, SwitchResult) and not result.success:
                self._refuse(PacketRefused("rejected by the arm", result.message, where=self._arm))
                return

    def _free(self, mode: ControlMode, status: GoalStatus) -> None:
        self.mode, self._direct = ControlMode.STOP, "off"
        self._bus.leases.release_run(self._holder.run)
        self._ended(mode, status)

    def _spawn(self, work: Coroutine[Any, Any, None], name: str) -> None:
        task = asyncio.get_running_loop().create_task(work, name=name)
        self._tasks.add(task)
        task.add_done_callback(self._done)

    def _done(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            _log.error("%s failed", task.get_name(), exc_info=error)


def _name_of(error: FlexcellError) -> Any:
    if isinstance(error, LeaseRefused):
        return "leased"
    return "not supported" if isinstance(error, NoSuchSkill) else "rejected by the arm"
