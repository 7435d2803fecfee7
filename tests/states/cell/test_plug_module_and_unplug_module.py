"""Plugging and unplugging modules: the requests to the module, and the cause of a refusal."""

from __future__ import annotations

import pytest

from engine.errors import Cause, LeaseRefused, NoSuchSkill, SkillFailed
from engine.skills import modules
from engine.skills.modules import ModuleState
from engine.state import Outcome
from states.cell.plug_module import PlugModule
from states.cell.unplug_module import UnplugModule
from tests.states.fake_context import FakeContext

PLUGGED = ModuleState(module="trolley", kind="trolley", connector="dock")
UNPLUGGED = ModuleState(module="trolley", kind="trolley", away=("trolley/block",))
ANSWERS = {"trolley/plug_module": PLUGGED, "trolley/unplug_module": UNPLUGGED}


async def test_a_module_is_plugged_to_the_connector_that_is_named() -> None:
    ctx = FakeContext(ANSWERS)
    state = PlugModule(module="trolley", connector="dock")
    assert (await state.run(ctx), state.resources()) == (Outcome("plugged"), ("trolley",))
    assert ctx.sent == [("trolley/plug_module", modules.PlugModule(connector="dock"))]


async def test_a_module_is_unplugged() -> None:
    ctx = FakeContext(ANSWERS)
    state = UnplugModule(module="trolley")
    assert (await state.run(ctx), state.resources()) == (Outcome("unplugged"), ("trolley",))
    assert ctx.sent == [("trolley/unplug_module", modules.UnplugModule())]


async def test_a_refusal_is_an_outcome_with_the_reason() -> None:
    refusal = SkillFailed("own touches it", where="cell")
    outcome = await UnplugModule(module="trolley").run(FakeContext({"trolley/unplug_module": refusal}))
    because = Cause(message="own touches it", where="cell", kind="SkillFailed")
    assert outcome == Outcome(
        "failed",
        cause=Cause(message="trolley was not unplugged", where="root/step", kind="cell.UnplugModule", because=because),
    )


async def test_a_module_that_another_run_has_is_an_outcome_too() -> None:
    held = LeaseRefused("trolley is held by run 1", where="trolley")
    outcome = await PlugModule(module="trolley").run(FakeContext({"trolley/plug_module": held}))
    assert outcome.name == "failed"


async def test_a_cell_without_the_module_is_a_mistake_of_the_behavior() -> None:
    with pytest.raises(NoSuchSkill):
        await PlugModule(module="trolley").run(FakeContext())
