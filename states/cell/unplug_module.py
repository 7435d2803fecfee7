"""cell.UnplugModule: unplugs a module of the cell."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.modules import UnplugModule as UnplugModuleRequest
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.cell.module_name import ModuleName


class UnplugModule(State, frozen=True, kw_only=True):
    """Unplug a module: it leaves the cell with the parts that are on it.

    Its parts that are elsewhere stay in the cell. It fails while an arm, a person or another part touches the module.
    """

    state_name: ClassVar[str] = "cell.UnplugModule"
    outcomes: ClassVar[tuple[str, ...]] = ("unplugged", "failed")
    success: ClassVar[tuple[str, ...]] = ("unplugged",)

    module: ModuleName

    def resources(self) -> tuple[str, ...]:
        """Return the module."""
        return (self.module,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the module."""
        what = f"{self.module} was not unplugged"
        return await call_or_fail(
            ctx, UnplugModuleRequest(), to=self.module, done="unplugged", what=what, kind=self.state_name
        )
