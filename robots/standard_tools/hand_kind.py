"""The kind of tool `hand`, as the table of tool kinds lists it."""

from __future__ import annotations

from engine.cell import ToolKind
from engine.messages import HandState
from engine.skills.hand import HandOpen

HAND = ToolKind(
    name="hand",
    measured=HandState,
    hold="hand.Close",
    release="hand.Open",
    check="hand.CheckHeld",
    release_goal=HandOpen(),
    mechanisms={"synergy": "robots.model.hand_mechanism:SynergyModel"},
    simulation="robots.standard_tools.hand_simulation:HAND_SIMULATION",
)
