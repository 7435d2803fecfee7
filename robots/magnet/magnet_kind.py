"""The kind of tool `magnet`, as the table of tool kinds lists it."""

from __future__ import annotations

from engine.cell import ToolKind
from robots.magnet.check_magnet import CheckHeld
from robots.magnet.magnet_skills import MagnetState, MagnetSwitch
from robots.magnet.switch_off import Off
from robots.magnet.switch_on import On

MAGNET = ToolKind(
    name="magnet",
    measured=MagnetState,
    hold=On.state_name,
    release=Off.state_name,
    check=CheckHeld.state_name,
    release_goal=MagnetSwitch(on=False),
    mechanisms={"magnet": "robots.magnet.magnet_model:MagnetModel"},
    simulation="robots.magnet.magnet_simulation:MAGNET_SIMULATION",
    switched="robots.magnet.switched_magnet:SWITCHED_MAGNET_KIND",
    states=(CheckHeld, Off, On),
)
