"""A kind of tool that is registered in the table is loaded, checked, simulated, driven and taught like all others."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.cell.cell_names import cell_names
from engine.cell.open_cell import OpenCell
from engine.check import check_file
from engine.document.cell import load_cell
from engine.errors import CellError, DocumentError
from engine.messages import Pose
from engine.registry import installed_state, load_states
from engine.skills.proposing import ProposalOptions, TaughtStep
from engine.teaching.behavior_proposal import build_proposal
from engine.teaching.step_roles import ObservedStep
from engine.testing import run_behavior
from robots.model.registry import robot_model
from robots.tool_kinds import TOOL_KINDS, kind_of_mechanism, tool_kind
from tests.robots.hook_tool import Catch, HookModel, HookState, HookTurn

TOOL = """\
flexcell: 1
tool: hook
title: A hook
urdf: {file: hook.urdf}
mechanism: {kind: hook, tip_link: tip, turn_s: 0.2}
licence: {name: CC0-1.0, file: hook.urdf}
"""
URDF = """<robot name="hook"><link name="tip"><inertial><mass value="0.1"/>
<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""
CELL = """\
flexcell: 1
cell: crane
world: {kind: mujoco}
robots:
  left: {model: ur10, gripper: {model: ./hook}}
  right: {model: ur10, base: {xyz: [0, 3, 0]}, gripper: {model: robotiq_2f85}}
parts: {plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1, at: {xyz: [0, -2, 0.005]}}}
"""
BEHAVIOR = """\
flexcell: 1
name: hang
cell: crane.yaml
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: catch
    states:
      catch: {state: hook.Catch, with: {hook: left}, transitions: {held: check, missed: bad, failed: bad}}
      check: {state: hook.CheckHeld, with: {hook: left}, transitions: {held: drop, lost: bad}}
      drop: {state: hook.Drop, with: {hook: left}, transitions: {dropped: good, failed: bad}}
"""


@pytest.fixture(autouse=True)
def registered(monkeypatch: pytest.MonkeyPatch) -> None:
    """The line in the table."""
    monkeypatch.setitem(TOOL_KINDS, "hook", "tests.robots.hook_tool:HOOK")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project with a hook's model, a cell and a behavior."""
    (tmp_path / "hook").mkdir()
    (tmp_path / "hook" / "tool.yaml").write_text(TOOL, encoding="utf-8")
    (tmp_path / "hook" / "hook.urdf").write_text(URDF, encoding="utf-8")
    (tmp_path / "crane.yaml").write_text(CELL, encoding="utf-8")
    (tmp_path / "hang.yaml").write_text(BEHAVIOR, encoding="utf-8")
    return tmp_path


def test_its_model_is_loaded_with_its_own_mechanism(folder: Path) -> None:
    tool = robot_model("ur10", gripper=str(folder / "hook")).tool
    assert tool is not None
    assert (tool.kind, tool.mechanism) == ("hook", HookModel(tip_link="hook_tip", turn_s=0.2))


@pytest.mark.parametrize(
    ("right", "wrong", "message", "hint"),
    [
        ("turn_s", "turn_ms", "unknown key `turn_ms`", "turn_s"),
        ("0.2", "-1.0", "`turn_s`: expected number > 0.0", "A number above 0"),
        ("tip_link: tip", "tip_link: tipp", "the URDF has no link tipp", "did you mean tip?"),
    ],
)
def test_a_mistake_in_its_document_is_found_where_it_is(
    folder: Path, right: str, wrong: str, message: str, hint: str
) -> None:
    """With line and column, and what was meant."""
    file = folder / "hook" / "tool.yaml"
    file.write_text(TOOL.replace(right, wrong), encoding="utf-8")
    with pytest.raises(DocumentError) as caught:
        robot_model("ur10", gripper=str(folder / "hook"))
    assert message in caught.value.message
    assert hint in (caught.value.hint or "")
    assert str(caught.value.where).startswith(f"{file}:5")


def test_a_behavior_with_its_states_is_checked_against_the_cell(folder: Path) -> None:
    """An arm without a hook is told apart, and which one has it."""
    names = cell_names(load_cell(folder / "crane.yaml"))
    assert (names.by_kind["hook"], "left/hook" in names.by_kind["tool"]) == ({"left"}, True)
    assert check_file(folder / "hang.yaml", load_states()) == ()
    (folder / "hang.yaml").write_text(BEHAVIOR.replace("{hook: left}", "{hook: right}", 1), encoding="utf-8")
    (finding,) = check_file(folder / "hang.yaml", load_states())
    assert finding.message == "the cell crane has no robot with a hook `right`"
    assert finding.hint == "`right` is a robot with a gripper"


@pytest.mark.virtual
async def test_its_skill_turns_it_in_the_simulated_world(folder: Path) -> None:
    async with OpenCell(load_cell(folder / "crane.yaml")) as cell:
        topic = cell.bus.topic("left/hook/state", HookState)
        assert topic.latest is not None
        assert not topic.latest.held
        started_s = cell.bus.clock.now_s()
        end = await cell.bus.send_goal(HookTurn(hooked=True), to="left/hook").result()
        assert end.status is GoalStatus.SUCCEEDED
        assert 0.2 <= cell.bus.clock.now_s() - started_s < 0.5
        assert topic.latest.held


def test_its_states_run_in_a_behavior(folder: Path) -> None:
    ran = run_behavior(folder / "hang.yaml", catalogue=load_states(), store=folder / "store.db")
    assert ran.outcome == "good"


def test_a_behavior_is_proposed_with_its_states() -> None:
    place = ObservedStep(
        TaughtStep(kind="pose", name="peg", role="grasp"), tool=Pose(xyz=(0.4, 0.2, 0.3), xyzw=(1.0, 0.0, 0.0, 0.0))
    )
    text = build_proposal([place], ProposalOptions(), arm="left", tool="hook").text
    assert "state: hook.Catch" in text
    assert "hook: left" in text
    assert "width_m" not in text


def test_it_picks_parts() -> None:
    """The general state takes any kind of tool; one that is not in the table is refused with what was meant."""
    pick = load_states()["manipulation.PickPart"]
    assert pick(robot="left", part="plate", tool="hook").resources() == ("left", "left/hook")  # pyright: ignore[reportCallIssue]
    with pytest.raises(ValueError, match=r"there is no kind of tool `hoook`: did you mean hook\?"):
        pick(robot="left", part="plate", tool="hoook")  # pyright: ignore[reportCallIssue]


def test_what_is_not_in_the_table_is_refused_with_what_was_meant() -> None:
    assert installed_state("hook.Catch") is Catch
    with pytest.raises(CellError) as caught:
        tool_kind("hoook")
    assert caught.value.hint == "did you mean hook?"
    with pytest.raises(CellError, match="no kind of tool has the mechanism tentacle"):
        kind_of_mechanism("tentacle")
