"""The states of the planning scene: what they ask the cell, and how they say that it refuses."""

from __future__ import annotations

import msgspec
import pytest

from engine.document.placement import Placement
from engine.errors import Cause, SkillFailed
from engine.messages import Pose
from engine.messages.shapes import Box, Capsule, Cylinder, Obstacle, Shape, Sphere
from engine.skills import planning_scene
from engine.skills.entries import EntryRecord
from engine.skills.planning_scene import FARTHEST_M, CheckCollision, CollisionReport, PlanningSceneState, TouchingPair
from engine.state import Outcome, State
from states.motion.motion_target import EntryTarget
from states.scene.allow_contact import AllowContact
from states.scene.attach import Attach
from states.scene.check import Check
from states.scene.detach import Detach
from states.scene.forget_occupancy import ForgetOccupancy
from states.scene.put_obstacle import PutObstacle
from states.scene.remove_obstacle import RemoveObstacle
from states.scene.shape_parameter_types import shape_of
from tests.states.fake_context import FakeContext

SCENE = PlanningSceneState(revision=1, obstacles=(), held=(), allowed=())
CRATE = PutObstacle(name="crate", size_m=(0.3, 0.2, 0.1), at=Placement(xyz=(1.0, 0.0, 0.5)))
ASKED = [
    (
        CRATE,
        "put",
        planning_scene.PutObstacle(
            obstacle=Obstacle.of("crate", Box(size_m=(0.3, 0.2, 0.1)), Pose(xyz=(1.0, 0.0, 0.5)))
        ),
    ),
    (RemoveObstacle(name="crate"), "removed", planning_scene.RemoveObstacle(name="crate")),
    (Attach(part="plate", robot="arm"), "attached", planning_scene.AttachPart(part="plate", robot="arm")),
    (Detach(part="plate"), "detached", planning_scene.DetachPart(part="plate")),
    (
        AllowContact(first="arm/tool", second="mat", allowed=False),
        "set",
        planning_scene.AllowContact(first="arm/tool", second="mat", allowed=False),
    ),
    (ForgetOccupancy(), "forgotten", planning_scene.ForgetOccupancy()),
]
IDS = [type(state).__name__ for state, _, _ in ASKED]


@pytest.mark.parametrize(("state", "done", "request_"), ASKED, ids=IDS)
async def test_the_cell_is_asked(state: State, done: str, request_: planning_scene.PutObstacle) -> None:
    address = f"cell/{request_.skill_name()}"
    ctx = FakeContext({address: SCENE})
    assert await state.run(ctx) == Outcome(done)
    assert ctx.sent == [(address, request_)]


@pytest.mark.parametrize(("state", "done", "request_"), ASKED, ids=IDS)
async def test_a_refusal_of_the_cell_is_failed_with_its_reason(
    state: State, done: str, request_: planning_scene.PutObstacle
) -> None:
    ctx = FakeContext({f"cell/{request_.skill_name()}": SkillFailed("there is no such thing", where="cell")})
    outcome = await state.run(ctx)
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert outcome.cause.kind == state.state_name
    assert [link.message for link in outcome.cause.chain()][1:] == ["there is no such thing"]


@pytest.mark.parametrize(
    ("name", "size_m", "shape"),
    [
        ("box", (0.3, 0.2, 0.1), Box(size_m=(0.3, 0.2, 0.1))),
        ("cylinder", (0.3, 1.0), Cylinder(radius_m=0.15, length_m=1.0)),
        ("sphere", (0.3,), Sphere(radius_m=0.15)),
        ("capsule", (0.25, 1.0), Capsule(radius_m=0.125, length_m=0.75)),
        ("capsule", (0.25, 0.25), Capsule(radius_m=0.125, length_m=0.0)),
    ],
)
def test_shapes_are_written_by_their_full_lengths(name: str, size_m: tuple[float, ...], shape: Shape) -> None:
    assert shape_of(name, size_m) == shape


@pytest.mark.parametrize(
    ("shape", "size_m", "message"),
    [
        ("box", [0.3, 0.2], "`size_m` of a box is its edges x, y and z"),
        ("sphere", [0.3, 0.2], "`size_m` of a sphere is its diameter"),
        ("capsule", [0.3, 0.2], "its diameter and its length of at least the diameter"),
        ("box", [0.3, 0.2, 0.0], "size_m"),
        ("cone", [0.3, 0.2], "cone"),
    ],
)
def test_a_shape_that_is_none_is_refused_with_the_document(shape: str, size_m: list[float], message: str) -> None:
    given = {"name": "crate", "shape": shape, "size_m": size_m, "at": {"xyz": [0, 0, 0]}}
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert(given, PutObstacle)


async def test_an_arm_that_touches_nothing_is_free_and_the_distance_comes_out() -> None:
    report = CollisionReport(touching=(), distance_m=0.04, nearest=("arm/link_3", "table"))
    ctx = FakeContext({"cell/check_collision": report})
    assert await Check(robot="arm").run(ctx) == Outcome("free", {"distance_m": 0.04, "touching": []})
    assert ctx.sent == [("cell/check_collision", CheckCollision(robot="arm"))]


async def test_an_empty_scene_has_a_finite_distance() -> None:
    """The record of a run holds no infinite number."""
    report = CollisionReport(touching=(), distance_m=FARTHEST_M, nearest=("", ""))
    outcome = await Check(robot="arm").run(FakeContext({"cell/check_collision": report}))
    assert outcome == Outcome("free", {"distance_m": FARTHEST_M, "touching": []})


async def test_what_touches_at_other_joints_is_named() -> None:
    pairs = (TouchingPair(first="arm/tool", second="table"), TouchingPair(first="arm/link_3", second="crate"))
    entry = EntryRecord(kind="joints", name="low", value={"joints": [0.1, 0.2], "names": []}, revision=1)
    report = CollisionReport(touching=pairs, distance_m=-0.01, nearest=("arm/tool", "table"))
    ctx = FakeContext({"store/read_entry": entry, "cell/check_collision": report})
    outcome = await Check(robot="arm", joints=EntryTarget(entry="low")).run(ctx)
    assert ctx.sent[1] == ("cell/check_collision", CheckCollision(robot="arm", joints=(0.1, 0.2)))
    assert outcome == Outcome(
        "touching",
        {"distance_m": -0.01, "touching": ["arm/tool with table", "arm/link_3 with crate"]},
        Cause(
            message="arm is not free at joints entry low",
            where="root/step",
            kind="scene.Check",
            because=Cause(message="arm/tool with table, arm/link_3 with crate touch", where="cell/check_collision"),
        ),
    )


async def test_nearer_than_the_margin_is_not_free() -> None:
    report = CollisionReport(touching=(), distance_m=0.01, nearest=("arm/link_3", "table"))
    outcome = await Check(robot="arm", margin_m=0.02).run(FakeContext({"cell/check_collision": report}))
    assert outcome.name == "touching"
    assert "arm/link_3 is 10.0 mm from table, 20.0 mm required" in str(outcome.cause)


async def test_a_check_that_cannot_be_made_is_failed() -> None:
    ctx = FakeContext({"cell/check_collision": SkillFailed("there is no robot amr", where="cell")})
    outcome = await Check(robot="amr").run(ctx)
    assert outcome.name == "failed"
    assert "there is no robot amr" in str(outcome.cause)
