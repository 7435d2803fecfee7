"""What an arm asks of the server of the tool it carries, whatever kind of tool that is."""

from __future__ import annotations

from typing import Protocol

from engine.bus import SkillBus
from robots.gripper.grasp_check import GraspCommand


class ToolServer(Protocol):
    """The skills of one tool on the bus; it belongs to its arm's `ArmServer`.

    Attributes:
        grip: What it was told to grasp and hold; None where nothing need be remembered.
    """

    grip: GraspCommand | None

    @property
    def name(self) -> str:
        """Its bus namespace, `<arm>/gripper`, `<arm>/hand` or `<arm>/magnet`."""
        ...

    @property
    def moving(self) -> bool:
        """True while a goal is carried out."""
        ...

    def register(self, bus: SkillBus) -> None:
        """Advertise its skills."""
        ...

    async def stop(self) -> None:
        """Stop what moves; what is held stays held."""
        ...
