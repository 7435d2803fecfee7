"""Skill server of one switchable magnet: implements the magnet skills over a `MagnetPort`, simulated or real."""

from __future__ import annotations

from engine.bus import ActiveGoal, SkillBus
from robots.gripper.tool_motion import ToolMotion
from robots.magnet.magnet_grasp_check import check_magnet_grasp, magnet_evidence, magnet_state
from robots.magnet.magnet_port import MagnetPort
from robots.magnet.magnet_skills import MagnetFeedback, MagnetResult, MagnetState, MagnetSwitch, ReadMagnet
from robots.port import GraspCommand


class MagnetServer:
    """Serves a magnet under `name`, usually `<arm>/magnet`; owned by its arm's `ArmServer`."""

    def __init__(self, *, name: str, port: MagnetPort) -> None:
        self.name = name
        self.grip: GraspCommand | None = None
        """None: switch state and pull determine whether something is held."""
        self._port = port
        self._motion = ToolMotion(device=name, words="the magnet")

    @property
    def moving(self) -> bool:
        """True while a goal is executing."""
        return self._motion.moving

    def register(self, bus: SkillBus) -> None:
        """Advertise the magnet skills."""
        bus.advertise_action(MagnetSwitch, self._switch, namespace=self.name, exclusive=self.name)
        bus.advertise_service(ReadMagnet, self._read, namespace=self.name)

    async def stop(self) -> None:
        """End the active motion; the field keeps its commanded state, and a held object stays held."""
        await self._motion.stop()

    async def _switch(self, goal: MagnetSwitch, handle: ActiveGoal[MagnetFeedback]) -> MagnetResult:
        handle.accept()

        def report() -> None:
            handle.feedback(MagnetFeedback(pull_n=self._port.sample().pull_n))

        await self._motion.carry_out(lambda: self._port.switch(on=goal.on), handle, report)
        sample = self._port.sample()
        reason = check_magnet_grasp(sample, max_force_n=self._port.max_force_n)
        return MagnetResult(
            on=sample.on,
            held=not reason,
            pull_n=sample.pull_n,
            part=sample.contact if not reason else "",
            reason=reason,
            by=magnet_evidence(sample),
        )

    async def _read(self, request: ReadMagnet) -> MagnetState:
        return self.state()

    def state(self) -> MagnetState:
        """Return the measured state."""
        return magnet_state(self._port.sample(), max_force_n=self._port.max_force_n)
