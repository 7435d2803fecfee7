"""A condition of a concurrency container: which children must have ended how, and how many of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec

AT_LEAST = "at_least"
"""Among the children of a condition, with a number in place of an outcome."""


class Condition(msgspec.Struct, frozen=True, kw_only=True):
    """`outcome` is taken when the children in `when` have ended with the outcome named for each.

    All of them, or any `at_least` of them.
    """

    outcome: str
    when: Mapping[str, str]
    at_least: int | None = None

    @property
    def needed(self) -> int:
        """How many of the children must have ended so."""
        return len(self.when) if self.at_least is None else self.at_least

    @property
    def needs_all(self) -> bool:
        """Whether it holds only when each child has ended as named."""
        return self.needed == len(self.when)

    def holds(self, has_ended: Callable[[str, str], bool]) -> bool:
        """Tell whether enough children have ended so, by what is said of a child and an outcome."""
        return sum(has_ended(name, due) for name, due in self.when.items()) >= self.needed

    def asks_only_for(self, is_meant: Callable[[str, str], bool]) -> bool:
        """Tell whether all that it asks for is what is meant, by what is said of a child and an outcome."""
        return all(is_meant(name, due) for name, due in self.when.items())

    def __str__(self) -> str:
        """Return what it asks for in words."""
        if self.needs_all:
            return " and ".join(f"{name}={due}" for name, due in self.when.items())
        return f"{self.needed} of " + ", ".join(f"{name}={due}" for name, due in self.when.items())


def read_condition(outcome: str, written: Mapping[str, object]) -> Condition:
    """Return a condition as documents write it, `{child: outcome, …}` with or without `at_least: number`."""
    # A child may have this name as well; what is written for it is text.
    count = written.get(AT_LEAST)
    when = {name: due for name, due in written.items() if isinstance(due, str)}
    return Condition(outcome=outcome, when=when, at_least=count if isinstance(count, int) else None)
