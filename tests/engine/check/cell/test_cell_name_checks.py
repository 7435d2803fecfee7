"""Robots, tools, parts, cameras, frames and the rest that a behavior names are looked for in its cell."""

from __future__ import annotations

import re
from pathlib import Path
from textwrap import dedent

import pytest

from engine.check import Finding, check_file
from tests.engine.check.checking import CATALOGUE, HEAD, findings_in_files

CELL = """
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda, gripper: {model: panda_hand}, outputs: {}}
  right: {model: ur10, gripper: {model: magnet}, outputs: {linear_axis: 4}}
fixtures: {table: {shape: box, size_m: [1, 1, 0.02], at: {xyz: [0, 0, -0.01]}}}
parts:
  plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1, at: {xyz: [0.4, 0, 0.1]}}
  bolt: {shape: cylinder, size_m: [0.01, 0.05], mass_kg: 0.1, at: {xyz: [0.4, 0.3, 0.1]}}
cameras:
  eye: {at: [1, 0, 1], look_at: [0, 0, 0], detect: {labels: {plate: steel plate}}}
  blind: {at: [1, 0, 1], look_at: [0, 0, 0]}
people: {anna: {shoulder: [2, 0, 1], hand_rests: [1.6, 0, 1]}}
"""
PINS = """
flexcell: 1
equipment: clamps
backend: {kind: simulated}
pins:
  clamp: {kind: digital_output, pin: 17, safe: true}
  valve: {kind: digital_output, pin: 22, safe: false}
  there: {kind: digital_input, pin: 27}
"""
WITH_EQUIPMENT = """
flexcell: 1
cell: bench
world: {kind: mujoco}
robots: {left: {model: panda, inputs: {}}}
equipment:
  vice: {pins: clamps.yaml}
  press: {driver: {kind: equipment, host: 10.0.0.2}}
"""
ENDS = {
    "io.ReadInput": "{'on': good, 'off': good, unknown: bad}",
    "io.WaitForInput": "{reached: good, timeout: bad, unknown: bad}",
    "motion.MoveJoints": "{reached: good, failed: bad}",
    "motion.MovePose": "{reached: good, failed: bad}",
    "motion.MoveFree": "{reached: good, blocked: bad, no_way: bad, failed: bad}",
    "gripper.Open": "{opened: good, failed: bad}",
    "magnet.Off": "{released: good, failed: bad}",
    "hand.Open": "{opened: good, failed: bad}",
    "manipulation.PickPart": "{picked: good, missed: bad, unreachable: bad, blocked: bad, failed: bad}",
    "manipulation.PlacePart": "{placed: good, missed: bad, unreachable: bad, blocked: bad, failed: bad}",
    "cell.ExpectPart": "{there: good, elsewhere: bad}",
    "cell.Withdraw": "{done: good, failed: bad}",
    "vision.Detect": "{found: good, not_found: bad, failed: bad}",
    "io.SetOutput": "{set: good, failed: bad}",
    "scene.Attach": "{attached: good, failed: bad}",
    "scene.AllowContact": "{set: good, failed: bad}",
    "scene.RemoveObstacle": "{removed: good, failed: bad}",
}
JOINTS = "target: [0, 0, 0, -1, 0, 1, 0]"


def finding_texts(folder: Path, state: str, given: str, *, head: str = "", cell: str = CELL) -> list[str]:
    """Check one state in a machine; returns `code text| message (hint)` of each finding."""
    main = f"""
cell: cell.yaml
{head}
root:
  machine:
    initial: it
    states:
      it:
        state: {state}
        with: {{{given}}}
        transitions: {ENDS[state]}
"""
    return [shown(each) for each in findings_in_files(folder, main=main, cell=cell)]


def shown(finding: Finding) -> str:
    """Write a finding with the text at its position, up to the next comma or bracket."""
    line = Path(finding.position.file).read_text(encoding="utf-8").splitlines()[finding.position.line - 1]
    at = re.split(r"[,:}\]]", line[finding.position.column - 1 :])[0]
    return f"{finding.code} {at}| {finding.message} ({finding.hint})"


@pytest.mark.parametrize(
    ("state", "given"),
    [
        ("motion.MoveJoints", f"robot: left, {JOINTS}"),
        ("motion.MovePose", "robot: left, target: {xyz: [0.4, 0, 0.3], frame: left/panda_link0}"),
        ("motion.MoveFree", f"robot: left, planner: RRTConnect, joints: {JOINTS[8:]}"),
        ("gripper.Open", "gripper: left"),
        ("magnet.Off", "magnet: right"),
        ("manipulation.PickPart", "robot: left, part: plate, width_m: 0.01, grasp: {xyz: [0, 0, 0], frame: part}"),
        ("manipulation.PickPart", "robot: right, part: plate, tool: magnet, grasp: {xyz: [0, 0, 0], frame: bolt}"),
        ("cell.ExpectPart", "part: bolt, frame: left/panda_hand"),
        ("cell.Withdraw", "person: anna"),
        ("vision.Detect", "camera: eye, label: steel plate"),
        ("vision.Detect", "camera: eye"),
        ("io.SetOutput", "robot: right, output: 9, value: true"),
        ("io.SetOutput", "robot: right, device: linear_axis, value: true"),
        ("scene.Attach", "part: bolt, robot: left, link: panda_link7"),
        ("scene.AllowContact", "first: left/panda_hand, second: table"),
        ("scene.AllowContact", "first: occupancy, second: anna/hand"),
        ("scene.RemoveObstacle", "name: table"),
    ],
)
def test_what_the_cell_has_is_no_finding(tmp_path: Path, state: str, given: str) -> None:
    """Each kind of name, as a world shows it."""
    assert finding_texts(tmp_path, state, given) == []


@pytest.mark.parametrize(
    ("state", "given", "message"),
    [
        (
            "motion.MoveJoints",
            f"robot: lefft, {JOINTS}",
            "lefft| the cell bench has no robot `lefft` (did you mean left?)",
        ),
        (
            "motion.MoveJoints",
            f"robot: anna, {JOINTS}",
            "anna| the cell bench has no robot `anna` (`anna` is a person)",
        ),
        (
            "motion.MovePose",
            "robot: left, target: {xyz: [0.4, 0, 0.3], frame: plate}",
            "plate| the cell bench has no frame for the poses of an arm `plate` (`plate` is a part)",
        ),
        (
            "motion.MovePose",
            "robot: left, target: {xyz: [0.4, 0, 0.3], frame: left/panda_lnk0}",
            "left/panda_lnk0| the cell bench has no frame for the poses of an arm `left/panda_lnk0` (did you",
        ),
        (
            "motion.MoveFree",
            f"robot: left, planner: RRTConect, joints: {JOINTS[8:]}",
            "RRTConect| the cell bench has no planner `RRTConect` (did you mean RRTConnect?)",
        ),
        (
            "gripper.Open",
            "gripper: right",
            "right| the cell bench has no robot with a gripper `right` (`right` is a robot with a magnet)",
        ),
        ("hand.Open", "hand: lft", "lft| the cell bench has no robot with a hand `lft` (there are none)"),
        (
            "manipulation.PickPart",
            "robot: left, part: plat, width_m: 0.01",
            "plat| the cell bench has no part `plat` (did you mean plate?)",
        ),
        (
            "manipulation.PickPart",
            "robot: right, part: plate, width_m: 0.01",
            "with| `right` of the cell bench has no tool `gripper` (known: magnet)",
        ),
        (
            "manipulation.PlacePart",
            "robot: left, part: plate, target: {xyz: [0, 0, 0], frame: bolt_1}",
            "bolt_1| the cell bench has no frame `bolt_1` (did you mean bolt?)",
        ),
        (
            "cell.ExpectPart",
            "part: bolt, frame: left/panda_hnd",
            "left/panda_hnd| the cell bench has no frame `left/panda_hnd` (did you mean left/panda_hand",
        ),
        ("cell.Withdraw", "person: ana", "ana| the cell bench has no person `ana` (did you mean anna?)"),
        ("vision.Detect", "camera: ey", "ey| the cell bench has no camera that detects `ey` (did you mean eye?)"),
        (
            "vision.Detect",
            "camera: blind",
            "blind| the cell bench has no camera that detects `blind` (`blind` is a camera)",
        ),
        (
            "vision.Detect",
            "camera: eye, label: plate",
            "plate| `eye` of the cell bench has no label `plate` (did you mean steel plate?)",
        ),
        (
            "io.SetOutput",
            "robot: right, output: 10, value: true",
            "10| `right` of the cell bench has no output `10` (",
        ),
        (
            "io.SetOutput",
            "robot: left, device: gripper, value: true",
            "gripper| `left` of the cell bench has no output `gripper` (there are none)",
        ),
        (
            "scene.Attach",
            "part: bolt, robot: left, link: panda_link9",
            "panda_link9| `left` of the cell bench has no link `panda_link9` (did you mean panda_link",
        ),
    ],
)
def test_what_the_cell_lacks_is_an_error_at_the_name(tmp_path: Path, state: str, given: str, message: str) -> None:
    """With what it may have meant, or what it is instead."""
    (found,) = finding_texts(tmp_path, state, given)
    assert found.startswith(f"unknown-in-cell {message}"), found


def test_names_that_a_run_may_add_are_warned_of(tmp_path: Path) -> None:
    """An obstacle may have been put by an earlier run; one that this behavior puts is there."""
    (found,) = finding_texts(tmp_path, "scene.AllowContact", "first: left, second: tabel")
    assert found == "maybe-unknown-in-cell tabel| the cell bench has no body `tabel` (did you mean table?)"
    main = """
    cell: cell.yaml
    root:
      machine:
        initial: put
        states:
          put:
            state: scene.PutObstacle
            with: {name: box, size_m: [0.1, 0.1, 0.1], at: {xyz: [1, 0, 0]}}
            transitions: {put: allow, failed: bad}
          allow: {state: scene.AllowContact, with: {first: left, second: box}, transitions: {set: take, failed: bad}}
          take: {state: scene.RemoveObstacle, with: {name: bx}, transitions: {removed: good, failed: bad}}
    """
    (only,) = findings_in_files(tmp_path, main=main, cell=CELL)
    assert (only.code, only.path, only.hint) == ("maybe-unknown-in-cell", "root/take", "did you mean box?")


def test_a_parameter_counts_with_its_default_and_all_its_choices(tmp_path: Path) -> None:
    """The message says that it is a default."""
    head = "parameters: {arm: {type: string, default: %s%s}}"
    given = f"robot: '${{arm}}', {JOINTS}"
    assert finding_texts(tmp_path, "motion.MoveJoints", given, head=head % ("left", "")) == []
    (found,) = finding_texts(tmp_path, "motion.MoveJoints", given, head=head % ("lefft", ""))
    assert found == (
        "unknown-in-cell '${arm| the cell bench has no robot `lefft`, which `${arm}` is by default (did you mean left?)"
    )
    (found,) = finding_texts(tmp_path, "motion.MoveJoints", given, head=head % ("left", ", choices: [left, rigt]"))
    assert found == (
        "maybe-unknown-in-cell '${arm| the cell bench has no robot `rigt`, which `${arm}` may be (did you mean right?)"
    )


def test_the_items_of_a_loop_and_the_values_of_userdata_count(tmp_path: Path) -> None:
    """Where they stand in the document, on every way that leads there."""
    main = """
    cell: cell.yaml
    userdata: {who: lft}
    root:
      machine:
        initial: each
        states:
          each:
            foreach:
              items: [bolt, plat]
              as: part
              child: {state: cell.ExpectPart, with: {part: "${part}", frame: world}, transitions: {}}
            transitions: {exhausted: open, broken: bad}
          open: {state: gripper.Open, with: {gripper: "${who}"}, transitions: {opened: good, failed: bad}}
    """
    found = findings_in_files(tmp_path, main=main, cell=CELL)
    assert [(each.code, each.hint) for each in found if "-in-cell" in each.code] == [
        ("maybe-unknown-in-cell", "did you mean plate?"),
        ("unknown-in-cell", "did you mean left?"),
    ]


def test_what_a_reference_is_given_counts_for_what_is_done_with_it_inside(tmp_path: Path) -> None:
    """The finding stands where the value is given; what is inside is not judged by its own default."""
    part = f"""
    parameters: {{arm: {{type: string, default: middle}}}}
    root:
      machine:
        initial: go
        states:
          go:
            state: motion.MoveJoints
            with: {{robot: "${{arm}}", {JOINTS}}}
            transitions: {{reached: good, failed: bad}}
    """
    main = """
    cell: cell.yaml
    root:
      machine:
        initial: sub
        states:
          sub: {behavior: part.yaml%s, transitions: {good: good, bad: bad}}
    """
    assert findings_in_files(tmp_path, main=main % ", with: {arm: left}", part=part, cell=CELL) == ()
    (given,) = findings_in_files(tmp_path, main=main % ", with: {arm: rigth}", part=part, cell=CELL)
    assert (given.code, given.hint, Path(given.position.file).name) == (
        "unknown-in-cell",
        "did you mean right?",
        "main.yaml",
    )
    (default,) = findings_in_files(tmp_path, main=main % "", part=part, cell=CELL)
    assert (default.path, "`middle`" in default.message) == ("root/sub", True)


def test_nothing_is_said_of_a_robot_whose_model_cannot_be_read(tmp_path: Path) -> None:
    """The check of the cell says it; here its tool and links may be any."""
    cell = CELL.replace("model: panda,", "model: ./mine,")
    assert finding_texts(tmp_path, "hand.Open", "hand: left", cell=cell) == []
    assert finding_texts(tmp_path, "cell.ExpectPart", "part: bolt, frame: left/any", cell=cell) == []


def test_names_are_left_unchecked_where_no_cell_is_named(tmp_path: Path) -> None:
    """And where it cannot be read, which is reported instead."""
    body = f"root: {{machine: {{initial: a, states: {{a: {{state: motion.MoveJoints, with: {{robot: x, {JOINTS}}}, "
    body += "transitions: {reached: good, failed: bad}}}}}\n"
    (tmp_path / "b.yaml").write_text(HEAD + body, encoding="utf-8")
    assert check_file(tmp_path / "b.yaml", CATALOGUE) == ()
    (tmp_path / "b.yaml").write_text(HEAD + "cell: none.yaml\n" + dedent(body), encoding="utf-8")
    assert [each.code for each in check_file(tmp_path / "b.yaml", CATALOGUE)] == ["invalid-cell"]


@pytest.mark.parametrize(
    ("state", "given", "message"),
    [
        ("io.SetOutput", "robot: vice, name: valve, value: true", ""),
        ("io.WaitForInput", "robot: vice, name: there, timeout_s: 1", ""),
        # Only its server knows the pins of the press.
        ("io.SetOutput", "robot: press, name: anything, value: true", ""),
        (
            "io.SetOutput",
            "robot: vice, name: there, value: true",
            "there| `vice` of the cell bench has no output `there` (known: clamp, valve)",
        ),
        (
            "io.ReadInput",
            "robot: vice, name: valve",
            "valve| `vice` of the cell bench has no input `valve` (known: there)",
        ),
        # Numbers change with the configuration of a server: names are what counts.
        (
            "io.SetOutput",
            "robot: vice, output: 0, value: true",
            "0| `vice` of the cell bench has no output `0` (known: clamp, valve)",
        ),
        (
            "io.SetOutput",
            "robot: vise, name: valve, value: true",
            "vise| the cell bench has no robot or equipment `vise` (did you mean vice?)",
        ),
        (
            "motion.MoveJoints",
            f"robot: vice, {JOINTS}",
            "vice| the cell bench has no robot `vice` (`vice` is equipment)",
        ),
    ],
)
def test_pins_of_equipment_are_known_by_name(tmp_path: Path, state: str, given: str, message: str) -> None:
    (tmp_path / "clamps.yaml").write_text(PINS, encoding="utf-8")
    found = finding_texts(tmp_path, state, given, cell=WITH_EQUIPMENT)
    assert found == ([f"unknown-in-cell {message}"] if message else [])
