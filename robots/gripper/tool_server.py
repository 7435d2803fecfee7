"""The interface between an arm's server and the server of its tool, for any kind of tool."""

from __future__ import annotations

from typing import Protocol

from engine.bus import SkillBus
from robots.port import GraspCommand


class ToolServer(Protocol):
    """The skills of one tool on the bus; owned by its arm's `ArmServer`.

    Attributes:
        grip: The active grasp command; None where there is nothing to remember.
    """

    grip: GraspCommand | None

    @property
    def name(self) -> str:
        """Its bus namespace, `<arm>/<kind of tool>`."""
        ...

    @property
    def moving(self) -> bool:
        """True while a goal is executing."""
        ...

    def register(self, bus: SkillBus) -> None:
        """Advertise its skills."""
        ...

    async def stop(self) -> None:
        """Stop all motion; a held object stays held."""
        ...
