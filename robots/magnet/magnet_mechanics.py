"""A switchable magnet in a simulated world: it attracts ferrous parts near its face; contact does the rest."""

from __future__ import annotations

import numpy as np

from robots.control.motion_event import AnyMotionEvent
from robots.magnet.magnet_body import MagnetIndices
from robots.magnet.magnet_drive import MagnetCommand, MagnetDrive
from robots.port import Array
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics

# Sample points of the field over the face, as shares of its half edge; without corners, as the face is round.
_GRID = (-0.8, -0.4, 0.0, 0.4, 0.8)
_POINTS = tuple((x, y) for x in _GRID for y in _GRID if x * x + y * y < 1.0)
# A gap of this share of the reach halves the field, which leaves a quarter of the force.
_QUARTER_SHARE = 1.0 / 3.0
# A ray that starts inside a body misses the near side: parts sink in a little.
_BACK_M = 0.01
# A switch has not ended while a part jumps to the face.
_STILL_M_S = 0.005


class MagnetMechanics:
    """Pulls every ferrous part with a force that is distributed over the face and decreases with the gap.

    A part pulled off by a larger force opens a gap and falls; a tilted part peels off from the
    edge. The reaction force acts on the magnet.
    """

    def __init__(
        self, indices: MagnetIndices, physics: Physics, contacts: ContactReader, *, own: frozenset[int]
    ) -> None:
        self._indices = indices
        self._physics = physics
        self._contacts = contacts
        self._own = own
        self.drive = MagnetDrive(switch_s=indices.model.switch_s)
        half_x, half_y, half_z = (edge / 2 for edge in indices.model.face.size_m)
        self._points: Array = np.array([(x * half_x, y * half_y, half_z) for x, y in _POINTS])
        self._radius_m = float(np.linalg.norm(self._points, axis=1).max())
        self._pulls: dict[int, tuple[Array, Array]] = {}

    def begin(self, motion: int, goal: tuple[float, ...]) -> None:
        """Switch; `goal` is 1 for on and 0 for off."""
        (on,) = goal
        self.drive.switch(motion, on=on > 0.0)

    def step(self, step_s: float) -> tuple[AnyMotionEvent, ...]:
        """Pull the parts within reach."""
        self._find_pulls()
        physics = self._physics
        for body, (force, point) in self._pulls.items():
            physics.attract(body, force=-force, point=point)
            physics.attract(self._indices.body, force=force, point=point)
        still = all(physics.speed(body) < _STILL_M_S for body in self._pulls)
        return self.drive.step(step_s, still=still)

    def measured(self) -> tuple[float, ...]:
        """Return progress, on, pull on the touching part, nothing, and the touching part."""
        (touched,) = self._contacts.touched((frozenset((self._indices.body,)),), own=self._own, fixed=True)
        pull_n = float(np.linalg.norm(self._pulls[touched][0])) if touched in self._pulls else 0.0
        return (self.drive.progress, float(self.drive.on), pull_n, 0.0, touched)

    def command(self) -> tuple[float, ...]:
        """Return on and level."""
        command = self.drive.command
        return float(command.on), command.level

    def take_over(self, command: tuple[float, ...]) -> None:
        """Resume from these values."""
        on, level = command[:2]
        self.drive.take_over(MagnetCommand(on=on > 0.0, level=level))
        self._find_pulls()

    def _find_pulls(self) -> None:
        """Compute the pull on each body and its point of application in the world."""
        self._pulls.clear()
        if self.drive.level == 0.0:
            return
        indices, physics, model = self._indices, self._physics, self._indices.model
        centre, axes = physics.geom_position(indices.face), physics.geom_axes(indices.face)
        out = axes[:, 2]
        points = centre + self._points @ axes.T
        share_n = self.drive.level * model.max_force_n / len(points)
        near_m = self._radius_m + model.reach_m
        for geom in indices.ferrous:
            if physics.geom_distance(geom, centre) > near_m:
                continue
            forces = np.array([share_n * self._fading(geom, point, out) for point in points])
            force_n = float(forces.sum())
            if force_n > 0.0:
                # Parallel forces act like their sum at their centre.
                self._pulls[physics.geom_body[geom]] = (force_n * out, forces @ points / force_n)

    def _fading(self, geom: int, point: Array, out: Array) -> float:
        """Return the remaining share of the force where the field, from `point` along `out`, meets a part."""
        reach_m = self._indices.model.reach_m
        gap_m = self._physics.ray(geom, point - _BACK_M * out, out) - _BACK_M
        if not -_BACK_M < gap_m <= reach_m:
            return 0.0
        return 1.0 / (1.0 + max(gap_m, 0.0) / (_QUARTER_SHARE * reach_m)) ** 2
