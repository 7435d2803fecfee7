"""bus.CallService: calls any service of the bus by its address."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, cast

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import LeaseRefused, SkillFailed
from engine.skill import NamedService
from engine.state import Context, Outcome, State
from states.bus.bus_parameter_types import Fields, SkillAddress, split_address


class CallService(State, frozen=True, kw_only=True):
    """Call a service by its address, where no state of its own exists.

    A response with `success: false`, as services that switch something give it, is the outcome `failed`.
    """

    state_name: ClassVar[str] = "bus.CallService"
    outcomes: ClassVar[tuple[str, ...]] = ("answered", "failed")
    success: ClassVar[tuple[str, ...]] = ("answered",)
    outputs: ClassVar[Mapping[str, Any]] = {"answer": object}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("answer",)}

    service: SkillAddress
    request: Fields = {}

    def resources(self) -> tuple[str, ...]:
        """Return the namespace of the service: a call may command it."""
        return (split_address(self.service)[0],)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service and return its answer."""
        namespace, name = split_address(self.service)
        try:
            answer = await ctx.call(NamedService(name=name, fields=self.request), to=namespace)
        except (SkillFailed, LeaseRefused) as error:
            return self._failed(ctx, cause_of(error))
        if isinstance(answer, dict):
            fields = cast("dict[str, object]", answer)
            if fields.get("success") is False:
                reason = SkillFailed(str(fields.get("message", "no reason was given")), where=self.service)
                return self._failed(ctx, cause_of(reason))
        return Outcome("answered", {"answer": cast("object", answer)})

    def _failed(self, ctx: Context, because: Any) -> Outcome:
        what = f"{self.service} did not do what it was called for"
        return Outcome("failed", cause=wrap_cause(what, because, where=ctx.path, kind=self.state_name))
