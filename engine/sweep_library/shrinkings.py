"""The failing runs of sweeps that are shrunk for a user interface: one at a time, in a process of its own."""

from __future__ import annotations

import asyncio
from pathlib import Path

import msgspec

from engine.errors import ControlError, RobotError
from engine.sweep.shrinking import SameAs
from engine.sweep_library.shrink_view import Shrinking, ShrunkTrial
from engine.sweep_library.sweep_files import sweep_file
from engine.sweep_library.sweep_process_link import SweepProcessLink
from engine.sweep_library.sweep_requests import Answered, Proceeding, Refused, ShrinkProceeding, ShrinkTrial

STOP_LIMIT_S = 60.0
"""Time that a run has for its end; then its process is killed, and nothing is found."""
_KEPT = 50
_Run = tuple[str, int]


class Shrinkings:
    """Belongs to one event loop; `close` ends its process. What was found is kept until the server ends.

    Args:
        project: The folder of the project.
    """

    def __init__(self, project: Path) -> None:
        self._project = project.resolve()
        self._known: dict[_Run, Shrinking] = {}
        self._process: SweepProcessLink | None = None
        self._following: asyncio.Task[None] | None = None

    def of(self, sweep_id: str, number: int) -> Shrinking:
        """Return how far a run is shrunk."""
        return self._known.get((sweep_id, number), Shrinking())

    async def start(self, sweep_id: str, number: int, *, same: SameAs) -> None:
        """Begin to shrink a run; how far it is tells `of`, also why it could not.

        Raises:
            ControlError: another run is being shrunk.
            FlexcellError: there is no such sweep, or no process for it.
        """
        await asyncio.to_thread(sweep_file, self._project, sweep_id)
        running = next((run for run, each in self._known.items() if each.status != "idle"), None)
        if running is not None:
            raise ControlError(
                "a run is being shrunk already",
                where=f"run {running[1]} of {running[0]}",
                hint="stop it, or wait for its end",
            )
        # Noted before anything is waited for, so that no second one begins meanwhile.
        run = (sweep_id, number)
        self._keep(run, Shrinking(status="running"))
        try:
            process = self._process = await SweepProcessLink.start(self._project)
            await process.send(ShrinkTrial(sweep=sweep_id, number=number, same=same))
        except BaseException:
            self._keep(run, Shrinking(problem="its process could not be started"))
            raise
        self._following = asyncio.create_task(self._follow(run, process), name=f"shrink run {number} of {sweep_id}")

    def stop(self, sweep_id: str, number: int) -> None:
        """End it with the smallest change found so far.

        Raises:
            ControlError: it is not being shrunk.
        """
        known = self.of(sweep_id, number)
        if known.status == "idle" or self._process is None:
            raise ControlError("this run is not being shrunk", where=f"run {number} of {sweep_id}")
        if known.status == "running":
            self._keep((sweep_id, number), msgspec.structs.replace(known, status="stopping"))
            self._process.interrupt()

    def note_case(self, sweep_id: str, number: int, case: str) -> None:
        """Keep where a run was saved as a test case."""
        self._keep((sweep_id, number), msgspec.structs.replace(self.of(sweep_id, number), saved_as=case))

    async def close(self) -> None:
        """End what is being shrunk."""
        if self._process is not None:
            self._process.close()
        if self._following is not None:
            await asyncio.wait({self._following})

    async def _follow(self, run: _Run, process: SweepProcessLink) -> None:
        ended = Shrinking()
        try:
            while True:
                stopping = self.of(*run).status == "stopping"
                match await process.receive(limit_s=STOP_LIMIT_S if stopping else None):
                    case ShrinkProceeding(progress=progress):
                        self._keep(run, msgspec.structs.replace(self.of(*run), progress=progress))
                    case Answered(body=body):
                        ended = Shrinking(found=msgspec.json.decode(body, type=ShrunkTrial))
                        return
                    case Refused(words=(message, where, _)):
                        ended = Shrinking(problem=f"{where}: {message}" if where else message)
                        return
                    case Proceeding():
                        pass
        except RobotError as error:
            ended = Shrinking(problem=error.message)
        finally:
            process.close()
            self._process = None
            self._keep(run, ended)

    def _keep(self, run: _Run, shrinking: Shrinking) -> None:
        self._known.pop(run, None)
        self._known[run] = shrinking
        oldest = next(iter(self._known))
        if len(self._known) > _KEPT and self._known[oldest].status == "idle":
            del self._known[oldest]
