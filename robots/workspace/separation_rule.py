"""The constants of speed and separation monitoring from a cell document (ISO/TS 15066, ISO 13855)."""

from __future__ import annotations

from engine.document import CellDocument, SpeedAndSeparationMonitoring
from robots.port import SeparationRule
from robots.vision.perception_device import PROCESSING_S

SUPERVISION_S = 0.02
"""Period in which distances are computed."""

# From the command of a new distance to its effect on the set point.
_COMMAND_S = 0.02
# ISO 13855: a sensor that resolves d <= 40 mm lets 8 (d - 14 mm) pass before it detects, a coarser one 850 mm.
_FINE_M, _FINEST_M, _SLOPE, _COARSE_M = 0.04, 0.014, 8.0, 0.85


def separation_rule(document: CellDocument) -> SeparationRule | None:
    """Return the rule of a cell, None without speed and separation monitoring."""
    monitoring, occupancy = document.speed_and_separation_monitoring, document.occupancy
    if monitoring is None or occupancy is None:
        return None
    slowest_s = max(1.0 / camera.rate_hz for camera in document.cameras.values())
    # A voxel beside one that is full already becomes full with the second image.
    delay_s = slowest_s + _COMMAND_S
    regular_s = slowest_s + PROCESSING_S + SUPERVISION_S + delay_s
    return SeparationRule(
        hand_speed_m_s=monitoring.hand_speed_m_s,
        reaction_s=max(monitoring.reaction_s or 0.0, regular_s),
        delay_s=delay_s,
        intrusion_m=_intrusion_m(monitoring, occupancy.voxel_m),
        uncertainty_m=monitoring.position_uncertainty_m,
    )


def rest_distance_m(rule: SeparationRule) -> float:
    """Return the protective distance of an arm at rest, whose stop takes no time and no way."""
    return rule.hand_speed_m_s * rule.reaction_s + rule.intrusion_m + rule.uncertainty_m


def _intrusion_m(monitoring: SpeedAndSeparationMonitoring, voxel_m: float) -> float:
    if monitoring.intrusion_distance_m is not None:
        return monitoring.intrusion_distance_m
    return _SLOPE * max(0.0, voxel_m - _FINEST_M) if voxel_m <= _FINE_M else _COARSE_M
