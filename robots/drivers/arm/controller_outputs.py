"""The digital outputs of a real controller: set by its control process, and read back."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable

from engine.errors import RobotError
from robots.drivers.arm.arm_process_messages import FromArmProcess, SetControllerOutput, ToArmProcess

_log = logging.getLogger("flexcell.devices")


class ControllerOutputs:
    """Implements `robots.port.OutputPort` and `ConfirmedOutputs`.

    Args:
        arm: Name of the arm.
        count: Number of outputs.
        values: Returns what the controller reads back.
        ask: Returns the answer of the control process to a request; raises RobotError.
    """

    def __init__(
        self,
        arm: str,
        *,
        count: int,
        values: Callable[[], tuple[bool, ...]],
        ask: Callable[[ToArmProcess], Awaitable[FromArmProcess]],
    ) -> None:
        self._arm = arm
        self.count = count
        self._values = values
        self._ask = ask
        # By output; of several the last counts.
        self._unconfirmed: dict[int, asyncio.Task[FromArmProcess]] = {}

    @property
    def values(self) -> tuple[bool, ...]:
        """Present values, as the controller reads them back."""
        return self._values()[: self.count]

    def set(self, output: int, *, on: bool) -> None:
        """Turn an output on or off; `confirmed` says when it is."""
        if not 0 <= output < self.count:
            hint = f"its outputs are 0 to {self.count - 1}"
            raise RobotError(f"there is no output {output}", where=self._arm, hint=hint)
        request = asyncio.ensure_future(self._request(output, on=on))
        self._unconfirmed[output] = request
        request.add_done_callback(lambda _: self._report(output, request))

    async def confirmed(self) -> None:
        """Return when the controller reads back what was set; raises RobotError."""
        requests, self._unconfirmed = list(self._unconfirmed.values()), {}
        await asyncio.gather(*requests)

    async def _request(self, output: int, *, on: bool) -> FromArmProcess:
        return await self._ask(SetControllerOutput(output=output, on=on))

    def _report(self, output: int, request: asyncio.Task[FromArmProcess]) -> None:
        """Report an error to the log while nobody has asked for it; who confirms later is told as well."""
        error = None if request.cancelled() else request.exception()
        if self._unconfirmed.get(output) is not request:
            return
        if error is None:
            del self._unconfirmed[output]
        else:
            _log.warning("%s: %s", self._arm, error)
