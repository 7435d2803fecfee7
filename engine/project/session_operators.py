"""The operators of the runs of a session: a run has one as long as anybody is attached to it."""

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
        """Leave on purpose; may be called again."""
        if self._leave():
            self._control.detach_operator()

    def lose(self) -> None:
        """Tell that this operator cannot be reached any more: without another one the loss policy applies."""
        if self._leave():
            self._control.lose_operator()

    def _leave(self) -> bool:
        """Tell whether the last one of a run that is under way has left."""
        if not self._open:
            return False
        self._open = False
        return self._operators.leave(self.run_id) and not self._control.closed


class OperatorRoster:
    """Counts them, by run."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}

    def attach(self, run_id: str, control: Control) -> RunOperator:
        """Add one; the first one turns the rules of autonomy on."""
        count = self._counts.get(run_id, 0)
        self._counts[run_id] = count + 1
        if count == 0:
            control.attach_operator()
        return RunOperator(self, run_id, control)

    def leave(self, run_id: str) -> bool:
        """Take one away; tells whether it was the last."""
        count = self._counts.pop(run_id) - 1
        if count > 0:
            self._counts[run_id] = count
        return count == 0
