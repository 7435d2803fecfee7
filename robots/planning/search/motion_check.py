"""Checks the trajectory of an arm that was not planned: a line, a profile, a primitive, a motion until contact.

Unlike a planned trajectory such a motion has contacts that are meant:

- what touches at its start may go on touching, no deeper than there, until it has separated;
- `at_end`: over the last `CONTACT_M` of the motion the tool, and what it holds, may touch a fixture or a part, no
  deeper than that: a grasp, a part that is placed, a button;
- `ends_path`: the first such contact ends the motion, and what would come after it does not count;
- `along_path`: the tool may touch them everywhere;
- `never`: none of these.

Contact of the other links, with arms and what they hold, and with what the cameras see, is a collision everywhere.

As in `path_check` spheres that contain the arm are checked first, and the exact checker where these are blocked; the
steps are those of the end section, as a contact there must be neither missed nor found early.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from engine.skills.planning_scene import CONTACT_M
from robots.planning.request import PathCheck, PathCheckRequest
from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair
from robots.planning.search.attached_part_check import (
    AllowedContacts,
    end_section_start,
    largest_motion_m,
    placing_pairs,
)
from robots.planning.search.kernels import Counts, check_along_path
from robots.planning.search.path_check import SelfCollisionCache, require_fit


def check_motion(
    request: PathCheckRequest,
    checker: Callable[[], ExactChecker],
    problem: CompiledProblem,
    known: SelfCollisionCache,
) -> PathCheck:
    """Return the first collision of a trajectory that was not planned, from a time on.

    Asks for the `checker` only where the spheres do not suffice.

    Raises:
        CellError: the trajectory does not fit this arm.
    """
    trajectory, rows = request.trajectory, request.trajectory.position_rad
    require_fit(trajectory, arm=request.arm, dof=problem.limits.shape[1])
    last = len(rows) - 1
    first = min(max(int(request.from_s / trajectory.dt_s), 0), last)
    ahead = np.ascontiguousarray(rows[first:])
    own_is_free = known.are_free(request.scene, request.arm, trajectory, request.from_s)
    outside = problem._replace(step_m=CONTACT_M, pairs=problem.pairs[:0], pair_gap=problem.pair_gap[:0])
    looked, near = np.empty(len(ahead), dtype=np.int64), np.empty(len(ahead), dtype=np.bool_)
    count = check_along_path(outside, ahead, looked, near)
    free = PathCheck(blocked_at_s=None, pairs=(), looked_s=last * trajectory.dt_s)
    if own_is_free and not near[:count].any():
        return free
    contacts = _MotionContacts(request, checker(), near=first + looked[:count][near[:count]])
    for row, may_touch in zip((first + looked[:count]).tolist(), near[:count].tolist(), strict=True):
        if own_is_free and not may_touch and not contacts.resting:
            continue
        refused, ended = contacts.at(row)
        if refused:
            at_s = min(max(row * trajectory.dt_s, request.from_s), last * trajectory.dt_s)
            return PathCheck(blocked_at_s=at_s, pairs=refused, looked_s=at_s)
        if ended:
            return PathCheck(blocked_at_s=None, pairs=(), looked_s=row * trajectory.dt_s)
    if not own_is_free:
        known.add(request.scene, request.arm, trajectory, request.from_s)
    return free


class _MotionContacts:
    """The contacts of one motion, row after row; `near` are the rows near anything outside of the arm."""

    def __init__(self, request: PathCheckRequest, checker: ExactChecker, *, near: Counts) -> None:
        self._mode = request.tool_contact
        self._checker = checker
        self._rows = rows = request.trajectory.position_rad
        tool = checker.tool_bodies
        self._contacts = [
            AllowedContacts(checks, placed=placing_pairs(checks, request.scene, bodies=tool), start=rows[0])
            for checks in checker.checks_along(rows[near])
        ]

    @property
    def resting(self) -> bool:
        """Whether something that touches at the start still touches."""
        return any(contacts.resting for contacts in self._contacts)

    def at(self, row: int) -> tuple[tuple[NamePair, ...], bool]:
        """Return the forbidden contacts at a row, deepest first, and whether an allowed one ends the motion."""
        refused: list[NamePair] = []
        ended = False
        for contacts in self._contacts:
            touching = contacts.too_near(self._rows[row], at_end=False)
            if self._mode == "at_end" and any(is_placed for _, is_placed in touching) and row >= self._end_row:
                # One that is deep already here began before the end section, if its row was not looked at.
                before = contacts.too_near(self._rows[max(0, self._end_row - 1)], at_end=False)
                touching = before or contacts.too_near(self._rows[row], at_end=True)
            for pair, is_placed in touching:
                if is_placed and self._mode == "ends_path":
                    ended = True
                else:
                    refused.append(pair)
        return tuple(dict.fromkeys(refused)), ended

    @cached_property
    def _end_row(self) -> int:
        rows = self._rows
        return end_section_start(self._checker.tool_points, rows, largest_motion_m(self._checker, rows))
