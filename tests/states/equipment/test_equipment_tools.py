"""equipment.TakeTool, PutTool and CheckTool: what is refused before anything moves."""

from __future__ import annotations

from engine.errors import Cause
from engine.messages import PartPoses, Pose
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.tool_changer import ChangeableTool, LockToolResult, ToolChangerState, ToolDescription
from engine.state import Outcome, State
from states.equipment.check_tool import CheckTool
from states.equipment.put_tool import PutTool
from states.equipment.select_tool_point import SelectToolPoint
from states.equipment.take_tool import TakeTool
from tests.states.fake_context import FakeContext, broken_off

PLATE = Pose(xyz=(0.0, 0.0, 0.01))
TOOL = ToolDescription(
    tool=ChangeableTool(name="probe", mass_kg=0.4, com_m=(0.0, 0.0, 0.02), tcps={"tip": PLATE}, plate=PLATE),
    docked=Pose(xyz=(0.5, 0.0, 0.3), xyzw=(1.0, 0.0, 0.0, 0.0)),
)
PLACE = Pose(xyz=(0.5, 0.0, 0.29))
ELSEWHERE = Pose(xyz=(0.5, 0.3, 0.02))
FAR = Pose(xyz=(0.2, 0.0, 0.6))
TAKE, PUT = TakeTool(robot="arm", tool="probe"), PutTool(robot="arm", tool="probe")


async def outcome(state: State, on: ToolChangerState, **parts: Pose) -> Outcome:
    """Return how a state ends without any motion: a goal would fail, as nobody answers it."""
    ctx = FakeContext(
        {"arm/read_tool_changer": on, "arm/describe_tool": TOOL, "arm/forward_kinematics": FAR},
        topics={"cell/parts": PartPoses(time_s=0.0, poses=parts)},
    )
    return await state.run(ctx)


def reason(found: Outcome) -> str:
    assert found.cause is not None
    return [each.message for each in found.cause.chain()][-1]


async def test_no_tool_is_taken_while_another_one_is_on() -> None:
    found = await outcome(TAKE, ToolChangerState(tool="hook", lock="locked"), probe=PLACE)
    assert (found.name, reason(found)) == ("occupied", "arm has hook")


async def test_an_empty_place_and_another_tool_in_it_are_missing() -> None:
    found = await outcome(TAKE, ToolChangerState(), probe=ELSEWHERE)
    assert (found.name, reason(found)) == ("missing", "probe is not in its place")
    found = await outcome(TAKE, ToolChangerState(), probe=ELSEWHERE, hook=PLACE)
    assert (found.name, reason(found)) == ("missing", "hook is in the place of probe")


async def test_nothing_is_put_into_an_occupied_place() -> None:
    found = await outcome(PUT, ToolChangerState(tool="probe", lock="locked"), probe=ELSEWHERE, hook=PLACE)
    assert (found.name, reason(found)) == ("occupied", "hook is in the place of probe")


async def test_what_is_not_on_is_not_put_back() -> None:
    found = await outcome(PUT, ToolChangerState(), probe=ELSEWHERE)
    assert (found.name, reason(found)) == ("missing", "arm has no tool")


async def test_what_hangs_in_its_place_is_put_back_already() -> None:
    """A state that is executed again after a resume does nothing twice."""
    assert await outcome(PUT, ToolChangerState(), probe=PLACE) == Outcome("put")


async def test_a_tool_that_is_on_and_out_of_its_place_is_taken_already() -> None:
    """Only its tool centre point is set; no goal of a motion is sent."""
    on = ToolChangerState(tool="probe", tcp="tip", lock="locked")
    ctx = FakeContext(
        {
            "arm/read_tool_changer": on,
            "arm/describe_tool": TOOL,
            "arm/forward_kinematics": FAR,
            "arm/lock_tool": GoalEnd(GoalStatus.SUCCEEDED, LockToolResult(ended="locked"), None),
        }
    )
    assert await TAKE.run(ctx) == Outcome("taken")


async def test_a_tool_centre_point_is_selected_of_the_tool_that_is_on_only() -> None:
    """A lock that is open stays open: there could be another tool at its face."""
    select = SelectToolPoint(robot="arm", tool="probe", tcp="side")
    assert (await outcome(select, ToolChangerState(), probe=PLACE)).name == "missing"
    locked = GoalEnd(GoalStatus.SUCCEEDED, LockToolResult(ended="locked"), None)
    on = ToolChangerState(tool="probe", tcp="tip", lock="locked")
    ctx = FakeContext({"arm/read_tool_changer": on, "arm/lock_tool": locked})
    assert await select.run(ctx) == Outcome("selected")
    refused = broken_off(GoalStatus.REJECTED, Cause(message="probe has no tool centre point side", where="arm"))
    ctx = FakeContext({"arm/read_tool_changer": on, "arm/lock_tool": refused})
    assert (await select.run(ctx)).name == "failed"


async def test_a_check_tells_why_the_tool_is_lost() -> None:
    check = CheckTool(robot="arm", tool="probe")
    assert (await outcome(check, ToolChangerState(tool="probe", lock="locked"))).name == "on"
    found = await outcome(check, ToolChangerState(lock="empty", problem="probe came off"))
    assert (found.name, reason(found)) == ("lost", "probe came off")
    found = await outcome(check, ToolChangerState(tool="hook", lock="locked"))
    assert (found.name, reason(found)) == ("lost", "arm has hook")
