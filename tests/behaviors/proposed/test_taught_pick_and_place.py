"""A behavior proposed from taught entries moves the payload of the UR10 in physics, as it stands in its document."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.check import check_file
from engine.document.entries_document import load_entries
from engine.messages import Vector3
from engine.registry import load_states
from engine.skills.proposing import ProposalOptions, StepKind, TaughtStep
from engine.store.entry_kinds import Pose, decode_entry
from engine.teaching.behavior_proposal import build_proposal
from engine.teaching.step_roles import ObservedStep
from tests.behaviors.application import BEHAVIORS, Application, causes, changed_cell, shipped_cell
from tests.tiers import nightly

ENTRIES = {(record.kind, record.name): record for record in load_entries(BEHAVIORS / "entries" / "ur10.yaml").records()}
PLACE_M = (-0.2, 0.98, 0.05)
OPTIONS = ProposalOptions(name="taught", cell=str(BEHAVIORS / "cells" / "ur10.yaml"), width_m=0.05, line_speed_m_s=0.25)
PARTS: dict[str, Vector3 | None] = {"payload": (0.2, 0.7, 0.05)}


def step(kind: StepKind, name: str) -> ObservedStep:
    """A step without a role."""
    pose = decode_entry(ENTRIES["pose", name], Pose) if kind == "pose" else None
    return ObservedStep(TaughtStep(kind=kind, name=name), tool=pose)


SHORT = [
    step("joints", "home"),
    step("pose", "pick"),
    step("action", "close"),
    step("pose", "place"),
    step("action", "open"),
]
WITH_APPROACHES = [
    *(step("joints", "home"), step("pose", "approach_pick"), step("pose", "pick"), step("action", "close")),
    *(step("pose", "approach_pick"), step("pose", "approach_place"), step("pose", "place"), step("action", "open")),
    *(step("pose", "approach_place"), step("joints", "home")),
]  # fmt: skip


def written(folder: Path, steps: list[ObservedStep]) -> str:
    """The file of the proposed behavior."""
    file = folder / "taught.yaml"
    file.write_text(build_proposal(steps, OPTIONS, arm="arm", parts=PARTS).text, encoding="utf-8")
    return str(file)


@pytest.mark.parametrize(
    "steps", [nightly(SHORT), WITH_APPROACHES], ids=["approaches by the tool's axis", "taught approaches"]
)
def test_the_payload_is_where_it_was_shown(steps: list[ObservedStep], tmp_path: Path) -> None:
    """The check finds nothing, the run ends well, and the part stands at the place."""
    file = written(tmp_path, steps)
    assert check_file(file, load_states()) == ()
    done = Application(behavior=file, cell=shipped_cell("ur10"), parameters={"speed": 0.5})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    assert math.dist(done.last("payload").xyz, PLACE_M) < 0.01


@pytest.mark.nightly
def test_an_entry_that_is_taught_anew_moves_the_same_behavior_elsewhere(tmp_path: Path) -> None:
    """The document has names, no numbers."""
    cell = changed_cell(
        "ur10", tmp_path, entries=lambda text: text.replace("place: {xyz: [-0.2, 0.98", "place: {xyz: [-0.1, 0.9")
    )
    done = Application(behavior=written(tmp_path, SHORT), cell=cell, parameters={"speed": 0.5})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    assert math.dist(done.last("payload").xyz, (-0.1, 0.9, 0.05)) < 0.01


def test_without_the_part_the_tool_is_open_and_back_and_the_outcome_says_so(tmp_path: Path) -> None:
    cell = changed_cell(
        "ur10", tmp_path, cell=lambda text: text.replace("at: {xyz: [0.2, 0.7, 0.05]}", "at: {xyz: [0.2, 0.5, 0.05]}")
    )
    done = Application(behavior=written(tmp_path, SHORT), cell=cell, parameters={"speed": 0.5})
    result = done.run(tmp_path)
    assert result.outcome == "missed"
    assert done.left[-6:] == [
        "root/pick_payload/grasp missed",
        "root/pick_payload/let_go opened",
        "root/pick_payload/detach detached",
        "root/pick_payload/back_off reached",
        "root/pick_payload missed",
        "root missed",
    ]
