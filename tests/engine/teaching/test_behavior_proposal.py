"""Behaviors proposed from taught entries: what their steps are for, what the documents do, that they are valid."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.cell import tool_kinds
from engine.check import check_behavior
from engine.document.loader import parse_behavior
from engine.errors import SkillFailed
from engine.messages import Pose, Vector3
from engine.registry import load_states
from engine.skills.proposing import Proposal, ProposalOptions, Role, StepKind, TaughtStep, ToolName
from engine.teaching.behavior_proposal import build_proposal
from engine.teaching.step_roles import ObservedStep, assign_step_roles, guess_part
from tests.tiers import examples

CATALOGUE = load_states()
PLAIN = ProposalOptions()
DOWN = (1.0, 0.0, 0.0, 0.0)
ABOVE, PICK, BIN = (
    Pose(xyz=(0.4, 0.2, 0.3), xyzw=DOWN),
    Pose(xyz=(0.4, 0.2, 0.1), xyzw=DOWN),
    Pose(xyz=(0.4, -0.2, 0.1), xyzw=DOWN),
)
PARTS: dict[str, Vector3 | None] = {"gear": (0.4, 0.21, 0.1), "lid": (1.0, 1.0, 0.0)}


def step(name: str, tool: Pose | None = None, *, kind: StepKind = "pose", role: Role | None = None) -> ObservedStep:
    return ObservedStep(TaughtStep(kind=kind, name=name, role=role), tool=tool)


CLOSE, OPEN = step("close", kind="action"), step("open", kind="action")
HELD = ObservedStep(TaughtStep(kind="gripper", name="around"), held=True, width_m=0.03, force_n=15.0)


def roles(*steps: ObservedStep) -> list[Role]:
    return [taught.role for taught in assign_step_roles(steps)]


def made(*steps: ObservedStep, options: ProposalOptions = PLAIN, tool: ToolName = "gripper") -> Proposal:
    return build_proposal(steps, options, arm="left", tool=tool, parts=PARTS)


def problems(proposal: Proposal) -> list[str]:
    """What the check finds in a document."""
    behavior = parse_behavior(proposal.text, file=Path("taught.yaml"))
    return [f"{one.code}: {one.message}" for one in check_behavior(behavior, CATALOGUE)]


def test_places_are_for_what_the_tool_does_there() -> None:
    """Opening with nothing in the tool releases nothing."""
    assert roles(step("a"), OPEN, step("b"), CLOSE, step("c"), step("d"), OPEN) == [
        "via", "open", "grasp", "close", "via", "release", "open",
    ]  # fmt: skip


def test_a_place_in_front_along_the_tool_is_an_approach_and_behind_it_a_depart() -> None:
    """One that is beside, or farther than 0.4 m, is not."""
    assert roles(step("x", ABOVE), step("y", PICK), CLOSE, step("x", ABOVE), step("z", BIN), OPEN) == [
        "approach", "grasp", "close", "via", "release", "open",
    ]  # fmt: skip
    assert (
        roles(step("x", ABOVE), step("y", PICK), CLOSE, step("x", ABOVE), step("v"), step("z", BIN), OPEN)[3]
        == "depart"
    )
    beside = Pose(xyz=(0.5, 0.2, 0.3), xyzw=DOWN)
    far = Pose(xyz=(0.4, 0.2, 0.6), xyzw=DOWN)
    assert [roles(step("x", place), step("y", PICK), CLOSE)[0] for place in (beside, far)] == ["via", "via"]


def test_without_a_word_of_the_tool_the_names_decide() -> None:
    assert roles(step("above_pick"), step("tray_pick"), step("home"), step("bin/place"), step("over_bin")) == [
        "approach", "grasp", "via", "release", "depart",
    ]  # fmt: skip


def test_what_somebody_chose_stays() -> None:
    """And what cannot be is refused with what can."""
    assert roles(step("tray_pick", role="via"), CLOSE) == ["via", "close"]
    with pytest.raises(SkillFailed, match=r"step 1: dmp sweep cannot be `grasp` \(it can be follow\)"):
        assign_step_roles([step("sweep", kind="dmp", role="grasp")])


def test_the_part_is_the_nearest_or_the_only_one() -> None:
    assert guess_part(step("a", PICK), PARTS) == "gear"
    assert guess_part(step("a", BIN), PARTS) == ""
    assert guess_part(step("a"), {"gear": None}) == "gear"


def test_a_grasp_and_a_release_have_their_states_around_them() -> None:
    """What was taught in the gripper is the default of a parameter."""
    proposal = made(step("home", kind="joints"), step("y", PICK), HELD, step("z", BIN), OPEN)
    assert problems(proposal) == []
    assert (proposal.words, proposal.remarks) == (("Move to home", "Pick gear at y", "Place gear at z"), ())
    behavior = parse_behavior(proposal.text, file=Path("taught.yaml"))
    pick, place = behavior.root.children["pick_gear"], behavior.root.children["place_gear_at_z"]
    assert list(pick.children) == [
        "open", "approach", "down", "grasp", "attach", "up", "check", "let_go", "detach", "back_off",
    ]  # fmt: skip
    assert list(place.children) == ["approach", "check", "down", "let_go", "detach", "up"]
    assert pick.children["grasp"].parameters == {
        "gripper": "left", "part": "gear", "width_m": "${width_m}", "force_n": 15.0,
    }  # fmt: skip
    assert {name: one.default for name, one in behavior.document.parameters.items()} == {
        "speed": 0.3, "line_speed_m_s": 0.1, "approach_m": 0.1, "width_m": 0.03,
    }  # fmt: skip
    assert (behavior.document.outcomes, behavior.document.success) == (
        ("finished", "missed", "blocked", "failed"),
        ("finished",),
    )


def test_taught_approaches_take_the_place_of_the_way_along_the_tool() -> None:
    """Nothing needs the distance then."""
    proposal = made(step("x", ABOVE), step("y", PICK), CLOSE, step("x", ABOVE), step("v"))
    assert problems(proposal) == []
    assert "approach_m" not in proposal.text
    assert proposal.words == ("Pick gear at y", "Move to v")


def test_two_grasps_of_different_widths_have_a_parameter_each() -> None:
    wider = ObservedStep(TaughtStep(kind="gripper", name="wide"), held=True, width_m=0.05)
    proposal = made(step("y", PICK), HELD, step("z", BIN), OPEN, step("y", PICK), wider, step("z", BIN), OPEN)
    assert problems(proposal) == []
    assert "${width_m}" in proposal.text
    assert "${width_2_m}" in proposal.text


def test_what_is_not_known_is_said() -> None:
    proposal = made(step("z", BIN), CLOSE)
    assert problems(proposal) == []
    assert [remark.split(":")[0] for remark in proposal.remarks] == [
        "The part grasped at z is unknown",
        "The width of the part is unknown",
        "The tool still holds a part at the end.",
    ]


@pytest.mark.parametrize("tool", tool_kinds())
def test_every_tool_grasps_and_lets_go_in_its_own_words(tool: ToolName) -> None:
    """A hand closes, a magnet is switched on."""
    assert problems(made(step("y", PICK), CLOSE, step("z", BIN), OPEN, CLOSE, OPEN, tool=tool)) == []


def test_poses_in_another_frame_are_gone_to_in_a_time() -> None:
    """Their distance, and so the speed, is not known."""
    place = ObservedStep(TaughtStep(kind="pose", name="in_tray"), frame="tray")
    proposal = made(place, CLOSE)
    assert problems(proposal) == []
    assert "line_speed_m_s" not in proposal.text


def test_nothing_that_moves_is_no_behavior() -> None:
    with pytest.raises(SkillFailed, match="no step moves the arm"):
        made(OPEN)


@st.composite
def some_step(draw: st.DrawFn) -> ObservedStep:
    """A place, a motion, or what the gripper does."""
    which = draw(st.integers(0, 2))
    if which == 0:
        kinds: list[StepKind] = ["pose", "joints"]
        name = draw(st.sampled_from(["a", "pick", "place", "above_it", "b/c.d-e"]))
        return step(name, draw(st.sampled_from([None, ABOVE, PICK, BIN])), kind=draw(st.sampled_from(kinds)))
    if which == 1:
        motions: list[StepKind] = ["dmp", "cart_dmp", "trajectory"]
        return step(draw(st.sampled_from(["wave", "pick"])), kind=draw(st.sampled_from(motions)))
    return draw(st.sampled_from([CLOSE, OPEN, HELD]))


@settings(max_examples=examples(30, nightly=240), deadline=None)
@given(
    st.lists(some_step(), min_size=1, max_size=9),
    st.sampled_from(sorted(tool_kinds())),
    st.floats(0.001, 1.0),
    st.floats(0.001, 0.5),
)
def test_whatever_is_taught_in_whatever_order_gives_a_behavior_without_findings(
    steps: list[ObservedStep], tool: ToolName, speed: float, approach_m: float
) -> None:
    """Or a refusal, where no step moves the arm."""
    options = ProposalOptions(speed=speed, approach_m=approach_m)
    if all(taught.step.kind in ("gripper", "action") for taught in steps):
        with pytest.raises(SkillFailed):
            made(*steps, options=options, tool=tool)
        return
    proposal = made(*steps, options=options, tool=tool)
    assert problems(proposal) == []
    assert len(proposal.steps) == len(steps)
    again = [replace(each, step=one) for one, each in zip(proposal.steps, steps, strict=True)]
    assert made(*again, options=options, tool=tool).text == proposal.text
