"""Times a path through waypoints, each of which the tool passes within a distance of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from engine.errors import RobotError
from robots.model.robot_model import JointLimits
from robots.planning.timing.blending import MIDDLE_SHARE, BlendedPath, blend_corners
from robots.planning.timing.time_parameterization import JointRateLimits, TimeParameterization, time_optimal
from robots.planning.timing.trajectory_timing import concatenate, longest_cut_rad, rate_limits, resting, stops_of
from robots.port import Array, JointTrajectory

_SLOWEST_SHARE, _LONGEST_S = 0.01, 600.0
_SAME_RAD = 1e-6
# A shorter blend would hardly be faster than a stop.
_SHORTEST_CUT_RAD = 1e-3
_HALVINGS = 12
_TOOL_LOOK_S = 0.01
# The time law is averaged, and the tool's speed is checked at some of its points.
_TOOL_SPEED_SHARE = 0.99
_SLOWEST_RATE = 1e-9

ToolPosition = Callable[[Array], Array]
"""From joints (n,) to the tool centre point (3,), metres."""


@dataclass(frozen=True, kw_only=True)
class TimedWaypoints:
    """A trajectory from rest to rest, and the time at which each waypoint but the first is passed."""

    trajectory: JointTrajectory
    passed_s: tuple[float, ...]


def time_waypoints(
    path: Array,
    *,
    blends_m: Sequence[float],
    tool_position: ToolPosition,
    limits: JointLimits,
    speed: float,
    speed_m_s: float | None = None,
) -> TimedWaypoints:
    """Return a trajectory along the straight joint lines between waypoints, (waypoints, n), with blended corners.

    The tool passes waypoint i within `blends_m[i]` of its position there; at 0, and where the path turns back, the
    arm rests. `speed` is as in `time_path`; `speed_m_s` also limits the speed of the tool centre point.

    Raises:
        RobotError: a speed is out of range, the motion would take too long, or the limits allow none.
    """
    if not _SLOWEST_SHARE <= speed <= 1.0:
        raise RobotError(f"the speed cannot be {speed:g}", hint=f"give a share from {_SLOWEST_SHARE:g} to 1")
    _require_duration(path, limits, speed)
    index_of, waypoints, blends = _distinct(path, blends_m)
    if len(waypoints) == 1:
        rest = resting(waypoints[0])
        return TimedWaypoints(trajectory=rest, passed_s=(rest.duration_s,) * (len(path) - 1))
    cuts = _cuts(waypoints, blends, tool_position)
    stops = list(pairwise(stops_of(cuts)))
    sections = tuple(blend_corners(waypoints[first : last + 1], cuts[first : last + 1]) for first, last in stops)
    allowed = rate_limits(limits, speed)
    laws = tuple(_law(section, allowed, tool_position, speed, speed_m_s) for section in sections)
    # The half blends before and after a corner are as long as the lines that they replace.
    corners = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(waypoints, axis=0), axis=1)))
    passed, begin_s = np.zeros(len(waypoints)), 0.0
    for (first, last), law in zip(stops, laws, strict=True):
        passed[first + 1 : last] = begin_s + law.times_at(corners[first + 1 : last] - corners[first])
        begin_s += law.duration_s
        passed[last] = begin_s
    if begin_s > _LONGEST_S:
        raise _too_long(begin_s, speed, speed_m_s)
    return TimedWaypoints(
        trajectory=concatenate(sections, laws), passed_s=tuple(float(passed[index]) for index in index_of[1:])
    )


def _require_duration(path: Array, limits: JointLimits, speed: float) -> None:
    """Raise RobotError before a path is timed that would take far too long."""
    turns = np.abs(np.diff(path, axis=0)) / (np.array(limits.velocity_rad_s) * speed)
    least_s = float(turns.max(axis=1).sum())
    if not least_s <= _LONGEST_S:
        raise _too_long(least_s, speed, None)


def _too_long(duration_s: float, speed: float, speed_m_s: float | None) -> RobotError:
    asked = f"a tool speed of {speed_m_s:g} m/s" if speed_m_s is not None else f"{speed:g} of the joint speeds"
    hint = f"the longest takes {_LONGEST_S:g} s: move faster, or divide it"
    return RobotError(f"the motion would take {duration_s:.0f} s with {asked}", hint=hint)


def _distinct(path: Array, blends_m: Sequence[float]) -> tuple[list[int], Array, list[float]]:
    """Return the index of each waypoint among the distinct ones, these, and their blends; the smallest blend counts."""
    index_of, kept, blends = [0], [0], [0.0]
    for i in range(1, len(path)):
        if float(np.linalg.norm(path[i] - path[kept[-1]])) > _SAME_RAD:
            kept.append(i)
            blends.append(float(blends_m[i]))
        else:
            blends[-1] = min(blends[-1], float(blends_m[i]))
        index_of.append(len(kept) - 1)
    return index_of, path[kept], blends


def _cuts(waypoints: Array, blends_m: Sequence[float], tool_position: ToolPosition) -> Array:
    """Return the length of each waypoint's blend, so long that its middle is within the distance; 0 for a stop."""
    lengths = np.linalg.norm(np.diff(waypoints, axis=0), axis=1)
    directions = np.diff(waypoints, axis=0) / lengths[:, None]
    cuts = np.zeros(len(waypoints))
    for i in range(1, len(waypoints) - 1):
        before, after = directions[i - 1], directions[i]
        longest = longest_cut_rad(before, after, (float(lengths[i - 1]), float(lengths[i])))
        if blends_m[i] <= 0.0 or longest == 0.0:
            continue
        corner, inward = waypoints[i], MIDDLE_SHARE * (after - before)

        def distance_m(cut: float, corner: Array = corner, inward: Array = inward) -> float:
            return float(np.linalg.norm(tool_position(corner + cut * inward) - tool_position(corner)))

        cut = _longest_within(longest, distance_m, blends_m[i])
        cuts[i] = cut if cut >= _SHORTEST_CUT_RAD else 0.0
    return cuts


def _longest_within(longest: float, distance_m: Callable[[float], float], most_m: float) -> float:
    """Return the longest cut, by bisection, whose middle is within `most_m` of the waypoint."""
    if distance_m(longest) <= most_m:
        return longest
    low, high = 0.0, longest
    for _ in range(_HALVINGS):
        cut = 0.5 * (low + high)
        low, high = (cut, high) if distance_m(cut) <= most_m else (low, cut)
    return low


def _law(
    path: BlendedPath, allowed: JointRateLimits, tool_position: ToolPosition, speed: float, speed_m_s: float | None
) -> TimeParameterization:
    """Return the time law of a section within the limits of the joints and of the tool's speed."""
    if speed_m_s is None:
        return time_optimal(path, allowed)
    tool = np.array([tool_position(row) for row in path.position])
    steps_m = np.linalg.norm(np.diff(tool, axis=0), axis=1)
    least_s = float(steps_m.sum()) / speed_m_s
    if not least_s <= _LONGEST_S:
        raise _too_long(least_s, speed, speed_m_s)
    rates = steps_m / np.diff(path.along)
    fastest = np.maximum(np.append(rates, 0.0), np.append(0.0, rates))
    most = (speed_m_s * _TOOL_SPEED_SHARE / np.maximum(fastest, _SLOWEST_RATE)) ** 2
    law = time_optimal(path, allowed, most_squares=most)
    times_s = np.linspace(0.0, law.duration_s, max(3, int(law.duration_s / _TOOL_LOOK_S)))
    seen = np.array([tool_position(row) for row in law.sampled(times_s)[0]])
    peak_m_s = float(np.linalg.norm(np.diff(seen, axis=0), axis=1).max() / (times_s[1] - times_s[0]))
    return replace(law, stretch=law.stretch * max(1.0, peak_m_s / (speed_m_s * _TOOL_SPEED_SHARE)))
