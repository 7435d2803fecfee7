"""What post-conditions of a part of a tree write, and what is known where one of them is evaluated."""

from __future__ import annotations

from collections.abc import Sequence

from engine.check.flow.effect import NOTHING, Effect, together, writing
from engine.check.flow.graph import Way
from engine.check.flow.read import Read, assignments
from engine.check.flow.site import Sites
from engine.check.subject import Placed

_AFTER = {"success": ("on_success", "always"), "failure": ("on_failure", "always")}
_HALTED = ("on_halted",)


class Assigned:
    """The writes of the post-conditions of one part, in the order in which they are made."""

    def __init__(self, placed: Placed, sites: Sites) -> None:
        self.writes: list[tuple[str, str, Effect]] = []
        """When, which key, and the effect; keys that nobody reads have none."""
        for _, when, key in assignments(placed):
            site = sites.add(key, "post", placed.path, f"{when} {key}")
            self.writes.append((when, key, writing(key, site, sites)))

    def at(self, label: str) -> Effect:
        """Return the effect behind an end that is called so."""
        return self._joined(_AFTER.get(label, ()))

    @property
    def halted(self) -> Effect:
        """The effect of being halted."""
        return self._joined(_HALTED)

    @property
    def anywhere(self) -> Effect:
        """What may be written at all."""
        return together(effect.perhaps() for _, _, effect in self.writes)

    def _joined(self, due: Sequence[str]) -> Effect:
        found = NOTHING
        for when, _, effect in self.writes:
            found = found.then(effect) if when in due else found
        return found


def fact_of_post(
    read: Read, before: int | None, ways: Sequence[Way], halted: Effect, post: Assigned, sites: Sites
) -> int | None:
    """Return what holds where a post-condition is evaluated; None where the part is never entered.

    Args:
        read: What it reads; its keys say which one it is.
        before: What holds before the part.
        ways: The ways out of the part, before its post-conditions.
        halted: What may be written when it is halted.
        post: All its post-conditions.
        sites: The places.
    """
    if before is None:
        return None
    _, when, key = read.keys
    found = 0
    for label, due in _AFTER.items():
        for way in ways if when in due else ():
            if way.label == label:
                found |= _until(way.effect.after(before, sites), str(when), str(key), due, post, sites)
    if when in _HALTED:
        found |= _until(halted.after(before, sites), str(when), str(key), _HALTED, post, sites)
    return found


def _until(fact: int, when: str, key: str, due: Sequence[str], post: Assigned, sites: Sites) -> int:
    for other, written, effect in post.writes:
        if (other, written) == (when, key):
            break
        fact = effect.after(fact, sites) if other in due else fact
    return fact
