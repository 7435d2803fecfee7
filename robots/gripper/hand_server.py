"""Skill server of one hand with one motor: implements the hand skills over a `HandPort`, simulated or real."""

from __future__ import annotations

from engine.bus import ActiveGoal, SkillBus
from engine.messages import HandState
from engine.skills.hand import HandClose, HandFeedback, HandOpen, HandResult, ReadHand
from robots.gripper.tool_motion import ToolMotion
from robots.port import GraspCommand, HandPort
from robots.port.hand_grasp_check import check_hand_grasp, hand_evidence, hand_state


class HandServer:
    """Serves a hand under `name`, usually `<arm>/hand`; owned by its arm's `ArmServer`."""

    def __init__(self, *, name: str, port: HandPort) -> None:
        self.name = name
        self.grip: GraspCommand | None = None
        """None: the contacts of fingers and palm determine whether something is held."""
        self._port = port
        self._motion = ToolMotion(device=name, words="the hand")

    @property
    def moving(self) -> bool:
        """True while a goal is executing."""
        return self._motion.moving

    def register(self, bus: SkillBus) -> None:
        """Advertise the hand skills."""
        bus.advertise_action(HandClose, self._close, namespace=self.name, exclusive=self.name)
        bus.advertise_action(HandOpen, self._open, namespace=self.name, exclusive=self.name)
        bus.advertise_service(ReadHand, self._read, namespace=self.name)

    async def stop(self) -> None:
        """Stop the motor where it is; a held object stays held."""
        await self._motion.stop()

    async def _close(self, goal: HandClose, handle: ActiveGoal[HandFeedback]) -> HandResult:
        handle.accept()
        return await self._close_to(goal.percent, goal.time_s, handle)

    async def _open(self, goal: HandOpen, handle: ActiveGoal[HandFeedback]) -> HandResult:
        handle.accept()
        return await self._close_to(0.0, goal.time_s, handle)

    async def _read(self, request: ReadHand) -> HandState:
        return hand_state(self._port.sample(), max_force_n=self._port.max_force_n)

    async def _close_to(self, percent: float, time_s: float, handle: ActiveGoal[HandFeedback]) -> HandResult:
        def report() -> None:
            handle.feedback(HandFeedback(closed_percent=100.0 * self._port.sample().closed_share))

        await self._motion.carry_out(lambda: self._port.close_to(share=percent / 100.0, time_s=time_s), handle, report)
        sample = self._port.sample()
        holding = check_hand_grasp(sample, max_force_n=self._port.max_force_n)
        return HandResult(
            held=bool(holding.part),
            closed_percent=100.0 * sample.closed_share,
            force_n=sample.force_n,
            part=holding.part,
            reason=holding.reason,
            by=hand_evidence(sample),
        )
