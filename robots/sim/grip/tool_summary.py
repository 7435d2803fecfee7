"""Summary of the tool on an arm for its port: kind of device, range, number of contacts."""

from __future__ import annotations

from typing import Literal

import msgspec

from robots.model.tool_model import ClawModel, GripperModel, LinkageModel, MagnetModel, SynergyModel, ToolModel

ToolDevice = Literal["gripper", "hand", "magnet"]
"""Also the last word of its bus address: `left/gripper`."""


class ToolSummary(msgspec.Struct, frozen=True, kw_only=True):
    """A tool as its port sees it; values that a kind does not have are 0.

    `contacts` is the number of places with a contact measurement: the pads of a gripper left then
    right, the fingers of a hand thumb first and then its palm, the face of a magnet.
    """

    device: ToolDevice
    contacts: int
    max_width_m: float = 0.0
    max_speed_m_s: float = 0.0
    min_force_n: float = 0.0
    max_force_n: float = 0.0
    shortest_time_s: float = 0.0
    """Time to close a hand fully."""


def tool_summary(tool: ToolModel | None) -> ToolSummary | None:
    """Return the summary of a tool, None for a bare flange."""
    if tool is None:
        return None
    match tool.mechanism:
        case GripperModel() | LinkageModel() | ClawModel() as fingers:
            return opening_summary(fingers)
        case SynergyModel() as hand:
            return ToolSummary(
                device="hand",
                contacts=len(hand.fingers) + 1,
                max_force_n=hand.max_force_n,
                shortest_time_s=hand.travel_m / hand.travel_speed_m_s,
            )
        case MagnetModel() as magnet:
            return ToolSummary(device="magnet", contacts=1, max_force_n=magnet.max_force_n)


def opening_summary(fingers: GripperModel | LinkageModel | ClawModel) -> ToolSummary:
    """Return the summary of a gripper with two fingers."""
    speed_m_s, force_n, least_n = 0.0, 0.0, 0.0
    match fingers:
        case GripperModel():
            speed_m_s, force_n = fingers.max_speed_m_s, fingers.max_force_n
        case LinkageModel():
            speed_m_s, force_n, least_n = fingers.max_speed_m_s, fingers.max_force_n, fingers.min_force_n
        case ClawModel():
            # A servo has an angle, a speed and a torque; the fingers convert them to lengths and forces.
            travel_m_rad = fingers.max_width_m / abs(fingers.closed_rad - fingers.open_rad)
            speed_m_s, force_n = fingers.max_speed_rad_s * travel_m_rad, fingers.max_effort_nm / travel_m_rad
    return ToolSummary(
        device="gripper",
        contacts=2,
        max_width_m=fingers.max_width_m,
        max_speed_m_s=speed_m_s,
        min_force_n=least_n,
        max_force_n=force_n,
    )
