"""A person switches devices between real and simulated: the cell is closed, and opened with the others."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence

import msgspec

from engine.document.cell import Cell, load_cell
from engine.document.simulated_devices import with_simulated_devices
from engine.errors import ControlError


class DrivenDeviceChoice(msgspec.Struct, frozen=True, kw_only=True):
    """A device for which the document of the cell names a driver: `left`, `left/gripper`.

    `simulated` says that the open cell simulates it instead.
    """

    device: str
    driver: str
    simulated: bool


class CellReopening:
    """Whether, and with which devices simulated, the owner of a session shall open its cell anew.

    Args:
        cell: The cell as it is open; None for one without a document.
        problem: Why the cell could not be opened as it was asked for last; empty if it was.
    """

    def __init__(self, cell: Cell | None, *, problem: str = "") -> None:
        self._cell = cell
        self._next: asyncio.Future[Cell] | None = None
        self._busy: Callable[[], str] = str
        self.problem = problem

    @property
    def devices(self) -> tuple[DrivenDeviceChoice, ...]:
        """The devices that can be switched, sorted."""
        cell = self._cell
        if cell is None:
            return ()
        written = {**cell.document.real_devices, **cell.simulated}
        return tuple(
            DrivenDeviceChoice(device=name, driver=driver, simulated=name in cell.simulated)
            for name, driver in sorted(written.items())
        )

    def refuse_while(self, busy: Callable[[], str]) -> None:
        """Refuse requests while `busy` returns a reason; it is asked at each request."""
        self._busy = busy

    async def requested(self) -> Cell:
        """Wait for a request and return the cell to be opened next."""
        self._next = asyncio.get_running_loop().create_future()
        return await self._next

    async def request(self, simulated: Sequence[str]) -> None:
        """Ask for the cell to be opened anew, from its document as it is now, with exactly these devices simulated.

        Raises:
            ControlError: nobody can open it anew, a run is active, or it would be the same cell.
            DocumentError: the document has errors, or has no such device.
        """
        if self._cell is None or self._next is None or self._next.done():
            raise ControlError(
                "this cell cannot be opened anew here", hint="serve it with `flexcell serve --cell CELL`"
            )
        file = self._cell.file
        cell = with_simulated_devices(await asyncio.to_thread(load_cell, file), simulated)
        busy = self._busy()
        if busy:
            raise ControlError(busy, where=self._cell.name, hint="wait for its end, or release the stop, then switch")
        if set(cell.simulated) == set(self._cell.simulated) and cell.content == self._cell.content:
            raise ControlError("these devices are simulated already", where=self._cell.name)
        if self._next.done():
            raise ControlError("the cell is being opened anew already", where=self._cell.name)
        self._next.set_result(cell)
