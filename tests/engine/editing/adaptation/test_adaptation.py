"""A behavior of one cell becomes a new document for another: names by kind and ability, all else as it was."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from engine.editing import ProjectContext, adapt
from engine.editing.adaptation.adaptation import AdaptedBehavior, proposed_file
from engine.errors import DocumentError, FlexcellError
from tests.engine.editing.edit_fixtures import STATES, difference

OLD_CELL = """
flexcell: 1
cell: old
world: {kind: mujoco}
store: {kind: sqlite, path: old.db, seed: old_entries.yaml}
robots:
  left: {model: panda, gripper: {model: panda_hand}}
  right: {model: ur10, gripper: {model: magnet}, outputs: {linear_axis: 4}}
parts:
  plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1, at: {xyz: [0.4, 0, 0.1]}}
  bolt: {shape: cylinder, size_m: [0.01, 0.05], mass_kg: 0.1, at: {xyz: [0.4, 0.3, 0.1]}}
cameras: {eye: {at: [1, 0, 1], look_at: [0, 0, 0], detect: {}}}
"""
NEW_CELL = """
flexcell: 1
cell: new
world: {kind: mujoco}
store: {kind: sqlite, path: new.db, seed: new_entries.yaml}
robots:
  lifter: {model: ur10, gripper: {model: magnet}, outputs: {linear_axis: 2}}
  arm: {model: panda, gripper: {model: panda_hand}}
parts:
  pin: {shape: cylinder, size_m: [0.012, 0.05], mass_kg: 0.1, at: {xyz: [0.4, 0, 0.1]}}
  sheet: {shape: box, size_m: [0.1, 0.12, 0.01], mass_kg: 0.1, at: {xyz: [0.4, 0.3, 0.1]}}
cameras:
  blind: {at: [1, 0, 1], look_at: [0, 0, 0]}
  top: {at: [1, 0, 1], look_at: [0, 0, 0], detect: {}}
"""
OLD_ENTRIES = "flexcell: 1\njoints: {left_home: [0, 0, 0, -1, 0, 1, 0], away: [0, 0, 0, -1, 0, 1, 0]}\n"
NEW_ENTRIES = "flexcell: 1\njoints: {arm_home: [0, 0, 0, -1, 0, 1, 0], up: [0, 0, 0, 0, 0, 0]}\n"
HEAD = "flexcell: 1\nname: work\ncell: cells/old.yaml\noutcomes: [good, bad]\nsuccess: [good]\n"
WORK = (
    HEAD
    + """\
parameters:
  which: {type: string, default: bolt, choices: [bolt, plate], description: What is taken}   # by name
root:
  machine:
    initial: home
    states:
      home:                       # slowly
        state: motion.MoveJoints
        with: {robot: left, target: {entry: left_home}, speed: 0.1}
        transitions: {reached: see, failed: bad}
      see:
        state: vision.Detect
        with: {camera: eye, label: plate}
        transitions: {found: valve, not_found: bad, failed: bad}
      valve:
        state: io.SetOutput
        with: {robot: right, device: linear_axis, value: true}
        transitions: {set: open, failed: bad}
      open:
        state: gripper.Open
        with: {gripper: left, part: plate}
        transitions: {opened: both, failed: bad}
      both:
        foreach:
          items: [plate, bolt]
          as: part
          child: {state: cell.ExpectPart, with: {part: "${part}", frame: world, tolerance_m: 1}}
        transitions: {exhausted: inner, broken: bad}
      inner: {behavior: nested/wait.yaml, with: {part: "${which}"}, transitions: {good: good, bad: bad}}
"""
)
WAIT = """\
flexcell: 1
name: wait
parameters: {part: {type: string, default: plate}}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: it
    states:
      it:
        state: cell.ExpectPart
        with: {part: "${part}", frame: world, tolerance_m: 1}
        transitions: {there: good, elsewhere: bad}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    files = {
        "cells/old.yaml": OLD_CELL,
        "cells/new.yaml": NEW_CELL,
        "cells/old_entries.yaml": OLD_ENTRIES,
        "cells/new_entries.yaml": NEW_ENTRIES,
        "work.yaml": WORK,
        "nested/wait.yaml": WAIT,
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def adapted(
    folder: Path, choices: dict[str, str] | None = None, *, text: str = WORK, output: str = ""
) -> AdaptedBehavior:
    cell, file = load_cell(folder / "cells/new.yaml"), folder / "work.yaml"
    target = folder / output if output else proposed_file(file, cell)
    context = ProjectContext(STATES, folder, folder)
    return adapt(text, file=file, output=target, cell=cell, context=context, choices=choices or {})


def targets(made: AdaptedBehavior) -> dict[str, str]:
    return {each.key: each.target for each in made.plan.names}


def test_names_become_what_is_most_like_them(folder: Path) -> None:
    """Arms by tool and joints, parts by shape, the camera that detects, entries only of a name that says so."""
    made = adapted(folder)
    assert targets(made) == {
        "robot:left": "arm",
        "robot:right": "lifter",
        "part:bolt": "pin",
        "part:plate": "sheet",
        "camera:eye": "top",
        "output:right/linear_axis": "lifter/linear_axis",
        "label:eye/plate": "top/sheet",
        "joints:left_home": "arm_home",
    }
    assert [each for each in made.plan.findings if each.severity == "error"] == []


def test_only_the_names_change_and_comments_stay(folder: Path) -> None:
    made = adapted(folder)
    assert difference(WORK, made.documents[0].text) == [
        "-name: work",
        "-cell: cells/old.yaml",
        "+name: work_new",
        "+cell: cells/new.yaml",
        "-  which: {type: string, default: bolt, choices: [bolt, plate], description: What is taken}   # by name",
        "+  which: {type: string, default: pin, choices: [pin, sheet], description: What is taken}   # by name",
        "-        with: {robot: left, target: {entry: left_home}, speed: 0.1}",
        "+        with: {robot: arm, target: {entry: arm_home}, speed: 0.1}",
        "-        with: {camera: eye, label: plate}",
        "+        with: {camera: top, label: sheet}",
        "-        with: {robot: right, device: linear_axis, value: true}",
        "+        with: {robot: lifter, device: linear_axis, value: true}",
        "-        with: {gripper: left, part: plate}",
        "+        with: {gripper: arm, part: sheet}",
        "-          items: [plate, bolt]",
        "+          items: [sheet, pin]",
        '-      inner: {behavior: nested/wait.yaml, with: {part: "${which}"}, transitions: {good: good, bad: bad}}',
        '+      inner: {behavior: nested/wait_new.yaml, with: {part: "${which}"}, transitions: {good: good, bad: bad}}',
    ]


def test_a_nested_behavior_that_names_things_is_copied_and_another_is_referred_to(folder: Path) -> None:
    made = adapted(folder, output="other/work.yaml")
    assert [each.file.relative_to(folder).as_posix() for each in made.documents] == [
        "other/work.yaml",
        "nested/wait_new.yaml",
    ]
    assert "default: sheet" in made.documents[1].text
    assert not (folder / "nested/wait_new.yaml").exists()
    (folder / "nested/wait.yaml").write_text(WAIT.replace(", default: plate", ""))
    again = adapted(folder, output="other/work.yaml")
    assert len(again.documents) == 1
    assert "behavior: ../nested/wait.yaml" in again.documents[0].text


def test_what_is_chosen_is_written_and_what_stays_is_found_by_the_check(folder: Path) -> None:
    made = adapted(folder, {"plate": "", "joints:left_home": "up"})
    assert (targets(made)["part:plate"], targets(made)["joints:left_home"]) == ("", "up")
    assert {each.code for each in made.plan.findings if each.severity == "error"} == {"unknown-in-cell"}
    assert any("part `plate`" in each.message for each in made.plan.findings)


def test_a_part_in_a_message_and_a_name_made_in_a_run(folder: Path) -> None:
    text = WORK.replace(
        "part: plate}\n        transitions: {opened", "part: \"${which + 'x'}\"}\n        transitions: {opened"
    )
    made = adapted(folder, text=text)
    assert [(each.path, each.expression) for each in made.plan.undecided] == [("root/open", "${which + 'x'}")]


@pytest.mark.parametrize(
    ("choices", "message"),
    [
        ({"robot:left": "nobody"}, "`left` cannot become `nobody` in the cell new"),
        ({"gone": "arm"}, "the behavior uses no `gone` of its cell"),
        ({"camera:eye": "blind"}, "`eye` cannot become `blind`"),
    ],
)
def test_a_choice_that_the_cell_cannot_keep_is_refused(folder: Path, choices: dict[str, str], message: str) -> None:
    with pytest.raises(FlexcellError, match=message):
        adapted(folder, choices)


def test_a_behavior_of_no_cell_needs_no_adapting(folder: Path) -> None:
    with pytest.raises(DocumentError, match="names no cell"):
        adapted(folder, text=WORK.replace("cell: cells/old.yaml\n", ""))


def test_a_named_frame_becomes_one_of_the_other_cell(folder: Path) -> None:
    """The same name first; a frame is neither a part nor a fixture."""
    for name, cell, frames in (("old", OLD_CELL, "slot: {}"), ("new", NEW_CELL, "dock: {}, slots: {}")):
        (folder / f"cells/{name}.yaml").write_text(f"{cell}frames: {{{frames}}}\n", encoding="utf-8")
    text = WORK.replace("frame: world", "frame: slot")
    made = adapted(folder, text=text)
    assert targets(made)["frame:slot"] == "slots"
    assert "frame: slots" in made.documents[0].text
    assert "frame: dock" in adapted(folder, {"slot": "dock"}, text=text).documents[0].text
