"""What a search goes towards: how near a run is to failure, as one number, the lower the nearer."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

from engine.sweep.execution.trial_result import TrialResult, require_number


@dataclass(frozen=True, kw_only=True)
class SearchTarget:
    """The number of a run whose least or largest value is searched for; a run that fails is beyond all of them."""

    name: str
    sign: float
    """1 where the least value is nearest to failure, -1 where the largest is."""
    guides: bool = True
    """Whether the number says how near a success is; else it is reported only, and all successes are equally near."""

    @classmethod
    def parse(cls, towards: str) -> Self:
        """Return the target that a valid `search.towards` names."""
        if towards == "failure":
            return cls(name="duration_s", sign=-1.0, guides=False)
        direction, _, name = towards.partition(" ")
        return cls(name=name.strip(), sign=1.0 if direction == "least" else -1.0)

    @property
    def text(self) -> str:
        """What is searched for, as it is written."""
        return f"{'least' if self.sign > 0.0 else 'most'} {self.name}"

    def value(self, result: TrialResult) -> float | None:
        """Return the number of a run; None where it has none."""
        return result.numbers.get(self.name)

    def score(self, result: TrialResult) -> float:
        """Return how near a run is to failure: -inf for one that failed, inf for one of which nothing is known."""
        if is_failure(result):
            return -math.inf
        if result.success and not self.guides:
            return 0.0
        value = self.value(result) if result.success else None
        return self.sign * value if value is not None and math.isfinite(value) else math.inf

    def require_known(self, results: Iterable[TrialResult], *, where: object) -> None:
        """Reject a number that no run that succeeded has.

        Raises:
            FlexcellError: there are such runs, and none has the number.
        """
        require_number(self.name, (each for each in results if each.success), where=where)


def is_failure(result: TrialResult) -> bool:
    """Return whether a run failed; a configuration that is refused shows no weakness of the behavior."""
    return not result.success and result.status != "refused"
