"""Speed and separation monitoring (ISO/TS 15066, 5.5.4): its constants and its measurements."""

from __future__ import annotations

import math

import msgspec


class SeparationRule(msgspec.Struct, frozen=True, kw_only=True):
    """The constant terms of the protective separation distance of a cell.

    `reaction_s` is the longest regular time from what a sensor sees to what the arm does about it, `delay_s` the part
    of it that follows the measurement. `intrusion_m` is how far a person enters before being measured (ISO 13855),
    `uncertainty_m` the uncertainty of the positions of person and arm.
    """

    hand_speed_m_s: float = 1.6
    reaction_s: float
    delay_s: float
    intrusion_m: float
    uncertainty_m: float


class MeasuredSeparation(msgspec.Struct, frozen=True, kw_only=True):
    """The smallest distance of an arm from what may be a person, measured `age_s` before it was sent.

    `distance_m` is infinite where nothing is measured. `extents_m` (n): how far the link behind each joint extends
    sideways from the line to the next joint; the last one how far tool and held part extend from their joint.
    """

    distance_m: float
    age_s: float
    extents_m: tuple[float, ...]


class PermittedSpeed(msgspec.Struct, frozen=True, kw_only=True):
    """What separation monitoring permits now: the share of the speed of the motion, and the speed of its fastest point.

    `protective_m` is the distance that full speed requires. Without a motion the last values are kept.
    """

    share: float = 1.0
    speed_m_s: float = math.inf
    protective_m: float = 0.0
