"""The operators of the runs of a session: a run has an operator while at least one person is attached."""

from __future__ import annotations

from engine.runtime.control import Control


class RunOperator:
    """One operator of one run; end it with `detach`, or with `lose` when the connection broke."""

    def __init__(self, operators: OperatorRoster, run_id: str, control: Control) -> None:
        self.run_id = run_id
        self._operators = operators
        self._control = control
        self._open = True

    def detach(self) -> None:
        """Detach deliberately; may be called again."""
        if self._leave():
            self._control.detach_operator()

    def lose(self) -> None:
        """Report that the connection to this operator is lost: without another operator the loss policy applies."""
        if self._leave():
            self._control.lose_operator()

    def _leave(self) -> bool:
        """Return whether this was the last operator of an active run."""
        if not self._open:
            return False
        self._open = False
        return self._operators.leave(self.run_id) and not self._control.closed


class OperatorRoster:
    """Counts operators by run."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}

    def attach(self, run_id: str, control: Control) -> RunOperator:
        """Add an operator; the first one activates the autonomy rules."""
        count = self._counts.get(run_id, 0)
        self._counts[run_id] = count + 1
        if count == 0:
            control.attach_operator()
        return RunOperator(self, run_id, control)

    def leave(self, run_id: str) -> bool:
        """Remove an operator; return whether it was the last one."""
        count = self._counts.pop(run_id) - 1
        if count > 0:
            self._counts[run_id] = count
        return count == 0
