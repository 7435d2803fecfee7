"""Clearance in a run: how near each arm, its tool and what it holds come to what they must not touch."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from robots.port import Array
from robots.sim.measures.clearance_pairs import ClearancePairs, ThingPair
from robots.sim.measures.passing_distance import APART_M, PassingDistance
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics

LIMIT_M = 0.5
"""What is farther away does not matter."""

_LONGEST_S = 0.04
# Between two looks, things move by at most this share of their distance, or by the resolution.
_SHARE = 0.5
_RESOLUTION_M = 0.001
# Arms may become faster until the next look.
_FASTER_M_S = 0.1


class _PairDistance:
    """Two things whose distance is followed."""

    def __init__(self, pair: ThingPair) -> None:
        self.pair = pair
        self.passing = PassingDistance() if pair.parts else None
        self.owners: tuple[str, ...] = ()
        """The arms that this distance is a clearance of; empty while it is none."""
        self.measured = 0
        """The number of the last look that measured it."""


class ClearanceMeasures:
    """Keeps a lower bound of the distance of each pair of geometries, and measures only what could be nearer.

    A bound decreases by what the two have moved since, rotation included. Only where it is below the least distance
    so far the distance is measured, by MuJoCo, as it measures contacts; it is the next bound. When to look
    again follows from how near and how fast things are, so that the least distance is met within a few percent.

    Two things of which one is a part may be meant to meet, see `PassingDistance`. A part counts while a tool holds it;
    its arm and it are no obstacles to each other then.

    Args:
        values: The measures of the world.
        arms: Where among them the clearance of each arm is.
        cell_value: Where that of the cell is.
        cell: The world.
        physics: Its physics.
        step_s: Duration of a step.
    """

    def __init__(
        self,
        values: Array,
        *,
        arms: Mapping[str, int],
        cell_value: int,
        cell: CellModel,
        physics: Physics,
        step_s: float,
    ) -> None:
        # It loads numba, which other parts of the package do without.
        from robots.sim.measures import clearance_kernels

        self._take_moved, self._least_row = clearance_kernels.take_moved, clearance_kernels.least_row
        self._values = values
        self._arms = arms
        self._cell_value = cell_value
        self._physics = physics
        self._step_s = step_s
        self._longest = max(1, round(_LONGEST_S / step_s))
        pairs = ClearancePairs(cell, physics)
        self._first, self._second, self._starts = pairs.first, pairs.second, pairs.starts
        self._geoms = list(zip(pairs.first.tolist(), pairs.second.tolist(), strict=True))
        self._things = [_PairDistance(pair) for pair in pairs.things]
        self._least = {arm: LIMIT_M for arm in arms if any(arm in pair.arms for pair in pairs.things)}
        self._bounds = np.zeros(len(pairs.first))
        self._levels = np.zeros(len(self._things))
        self._nearest = np.zeros(len(self._things))
        self._moved = np.zeros(len(physics.geom_radii))
        self._xyz, self._rotations = physics.geom_centres.copy(), physics.geom_rotations.copy()
        self._changed = False
        self._grasps: frozenset[tuple[str, int]] = frozenset()
        self._looked, self._looks = 0, 0
        self.due = 0
        """The step after which to look again."""
        self.restart(0)

    def restart(self, step: int) -> None:
        """Begin again after the world has jumped to another state at this step."""
        self._least = dict.fromkeys(self._least, LIMIT_M)
        self._looked = step
        # Where nothing can be touched, never.
        self.due = step if self._things else np.iinfo(np.int64).max
        self._grasps = frozenset()
        for things in self._things:
            things.owners = _owners(things.pair, self._grasps)
            if things.passing is not None:
                things.passing.restart()
                things.measured = self._looks
        xyz, radii, first, second = self._physics.geom_centres, self._physics.geom_radii, self._first, self._second
        self._bounds[:] = np.sqrt(np.square(xyz[first] - xyz[second]).sum(axis=1)) - radii[first] - radii[second]
        self._xyz[:], self._rotations[:] = xyz, self._physics.geom_rotations
        self._set_levels()
        self._write()

    def look(self, step: int, grasps: frozenset[tuple[str, int]]) -> None:
        """Look at the distances after the step just done.

        Args:
            step: Its number.
            grasps: Each arm and the part that its tool takes, holds or releases now, by its body.
        """
        speed_m_s = self._lower_bounds(step)
        if grasps != self._grasps:
            self._change_owners(grasps)
        self._looks += 1
        reach = self._levels + max(2.0 * speed_m_s * _LONGEST_S, APART_M)
        gap_m = math.inf
        for index in (self._nearest < reach).nonzero()[0].tolist():
            gap_m = min(gap_m, self._measure(self._things[index], float(reach[index])))
        if self._changed:
            self._set_levels()
            self._write()
        steps = gap_m / (2.0 * speed_m_s + _FASTER_M_S) / self._step_s
        self.due = step + max(1, math.floor(min(steps, self._longest)))

    def totals(self) -> dict[int, float]:
        """Return the clearances by their place among the measures, approaches that still last included."""
        least = dict(self._least)
        for things in self._things:
            if things.passing is not None:
                for arm in things.owners:
                    least[arm] = min(least[arm], things.passing.lasting_m)
        return self._places(least)

    def _lower_bounds(self, step: int) -> float:
        """Take from the bounds what has moved since the last look, and return the largest speed."""
        physics = self._physics
        moved_m = self._take_moved(
            physics.geom_centres,
            physics.geom_rotations,
            self._xyz,
            self._rotations,
            physics.geom_radii,
            self._first,
            self._second,
            self._starts,
            self._moved,
            self._bounds,
            self._nearest,
        )
        passed_s = (step - self._looked) * self._step_s
        self._looked = step
        return moved_m / passed_s if passed_s else 0.0

    def _measure(self, things: _PairDistance, reach_m: float) -> float:
        """Measure a distance, and return how far one of the two may move until the next time."""
        bounds, distance_m = self._bounds, math.inf
        start, end = things.pair.start, things.pair.end
        while bounds[row := self._least_row(bounds, start, end)] < min(distance_m, reach_m):
            bounds[row] = measured_m = self._physics.distance_m(*self._geoms[row])
            distance_m = min(distance_m, measured_m)
        owners = things.owners
        least_m = min([self._least[arm] for arm in owners])
        counts_m = distance_m if things.passing is None else self._passed_at(things, things.passing, distance_m)
        if counts_m < max([self._least[arm] for arm in owners]):
            self._changed = True
            for arm in owners:
                self._least[arm] = min(self._least[arm], counts_m)
        return max(distance_m - least_m, _SHARE * distance_m, _RESOLUTION_M)

    def _passed_at(self, things: _PairDistance, passing: PassingDistance, distance_m: float) -> float:
        """Return the distance at which two things have passed each other by now."""
        passed_m = self._unmeasured(things, passing) if things.measured < self._looks - 1 else math.inf
        things.measured, lasting_m = self._looks, passing.lasting_m
        passed_m = min(passed_m, passing.follow(distance_m))
        self._changed |= passing.lasting_m != lasting_m
        return passed_m

    def _unmeasured(self, things: _PairDistance, passing: PassingDistance) -> float:
        """Follow an approach while its distance was not measured, because it was larger than this."""
        least_m = max([self._least[arm] for arm in things.owners])
        lasting_m = passing.lasting_m if passing.lasting_m < math.inf else least_m
        return passing.follow(max(least_m, lasting_m) + APART_M)

    def _change_owners(self, grasps: frozenset[tuple[str, int]]) -> None:
        self._grasps = grasps
        for things in self._things:
            passing, owners = things.passing, _owners(things.pair, grasps)
            if passing is None or owners == things.owners:
                continue
            if things.owners and things.measured < self._looks:
                passed_m = self._unmeasured(things, passing)
                for arm in things.owners:
                    self._least[arm] = min(self._least[arm], passed_m)
            if not owners or not things.owners:
                passing.restart()
                things.measured = self._looks
            things.owners = owners
        self._set_levels()
        self._write()

    def _set_levels(self) -> None:
        self._changed = False
        for index, things in enumerate(self._things):
            level = max((self._least[arm] for arm in things.owners), default=-math.inf)
            if things.passing is not None and things.owners and things.passing.lasting_m < math.inf:
                level = max(level, things.passing.lasting_m)
            self._levels[index] = level

    def _write(self) -> None:
        for place, value in self._places(self._least).items():
            self._values[place] = value

    def _places(self, least: Mapping[str, float]) -> dict[int, float]:
        found = {self._arms[arm]: value for arm, value in least.items()}
        return {**found, self._cell_value: min(least.values())} if least else found


def _owners(pair: ThingPair, grasps: frozenset[tuple[str, int]]) -> tuple[str, ...]:
    """Return the arms that the distance of two things is a clearance of."""
    if not pair.parts:
        return pair.arms
    handled = [{arm for arm, part in grasps if part == body} for body in pair.parts]
    if pair.arms:
        holders = handled[0]
        return () if holders.issuperset(pair.arms) else tuple(sorted({*pair.arms, *holders}))
    # What one arm holds together is no obstacle to itself.
    return () if len(handled) > 1 and handled[0] & handled[1] else tuple(sorted(set[str]().union(*handled)))
