"""cell.PlugModule: plugs a module into a connector of the cell."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.modules import PlugModule as PlugModuleRequest
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.cell.module_name import ConnectorName, ModuleName


class PlugModule(State, frozen=True, kw_only=True):
    """Plug a module into a connector; then what stands on it is in the cell, for physics, planning and cameras.

    From then on until its end the run has the module to itself: no other run and no person unplugs it.
    """

    state_name: ClassVar[str] = "cell.PlugModule"
    outcomes: ClassVar[tuple[str, ...]] = ("plugged", "failed")
    success: ClassVar[tuple[str, ...]] = ("plugged",)

    module: ModuleName
    connector: ConnectorName = ""

    def resources(self) -> tuple[str, ...]:
        """Return the module."""
        return (self.module,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the module."""
        what = f"{self.module} was not plugged"
        request = PlugModuleRequest(connector=self.connector)
        return await call_or_fail(ctx, request, to=self.module, done="plugged", what=what, kind=self.state_name)
