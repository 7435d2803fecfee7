"""Cell documents: the demo cell, resolved paths, and mistakes with their positions."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from engine.document import Placement, load_cell
from engine.document.cell_store_spec import MongoStoreSpec, SqliteStoreSpec
from engine.errors import DocumentError, Position

DEMO = Path(__file__).parents[3] / "behaviors" / "cells" / "dual_panda.yaml"

SMALL = """flexcell: 1
cell: small
store: {kind: sqlite, path: data/cell.db, seed: ../entries/small.yaml}
world: {kind: mujoco}
robots:
  left: {model: panda, base: {xyz: [0, 0.5, 0], rpy: [0, 0, 1.5]}, gripper: {model: panda_hand}}
fixtures:
  table: {shape: box, size_m: [1, 1, 0.1], color: "#aabbcc"}
parts:
  can: {shape: cylinder, size_m: [0.05, 0.1], mass_kg: 0.2, jitter: {xy_m: 0.01}}
people:
  anna: {shoulder: [0, -0.8, 0.4], hand_rests: [0, -0.6, 0.1]}
unknown_bodies:
  crate: {shape: box, size_m: [0.2, 0.2, 0.2], at: {xyz: [0.4, 0, 0.1]}}
"""

WRONG: dict[str, tuple[str, str, str, str]] = {
    "mistyped key": ("model: panda,", "modl: panda,", "modl", "did you mean model?"),
    "no mass": ("mass_kg: 0.2", "mass_kg: 0", "0,", "Mass in kilograms"),
    "unknown shape": ("shape: box", "shape: sphere", "sphere", "there is no choice 'sphere'"),
    "cylinder with three lengths": (
        "[0.05, 0.1]",
        "[0.05, 0.1, 0.1]",
        "[0.05",
        "has 2 lengths, not 3 (diameter, length)",
    ),
    "sphere with two lengths": ("shape: cylinder", "shape: sphere", "[0.05", "has one length, not 2 (diameter)"),
    "box with two lengths": ("[1, 1, 0.1]", "[1, 1]", "[1, 1]", "has 3 lengths, not 2"),
    "sprung tray": (
        "shape: box, size_m: [1, 1, 0.1],",
        "shape: tray, size_m: [1, 1, 0.1], spring: {stiffness_n_m: 1000},",
        "{stiffness",
        "a tray cannot have a spring",
    ),
    "unknown world": ("kind: mujoco", "kind: gazebo", "gazebo", "'gazebo'"),
    "unknown store": ("kind: sqlite", "kind: mongo", "mongo", "'mongo'"),
    "no world": ("world: {kind: mujoco}\n", "", "left", "robot `left` is simulated, but the cell has no world"),
    "capital in a name": ("left:", "Left:", "Left", "Lower-case letters"),
    "unknown driver word": ("model: panda,", "model: panda, driver: real,", "real", "known: sim"),
    "driver without kind": ("model: panda,", "model: panda, driver: {host: x},", "{host", "has no `kind`"),
    "color word": ('"#aabbcc"', "red", "red", "#rrggbb"),
    "person named as a robot": ("anna:", "left:", "left", "`left` is both a person and a robot"),
    "person named as a part": ("anna:", "can:", "can", "`can` is both a person and a part"),
    "person named as a fixture": ("anna:", "table:", "table", "`table` is both a person and a fixture"),
    "hand out of reach": (
        "[0, -0.6, 0.1]",
        "[0, -0.1, 0.1]",
        "[0, -0.1",
        "0.762 m from the shoulder (its reach is 0.050",
    ),
    "hand in the shoulder": ("[0, -0.6, 0.1]", "[0, -0.8, 0.41]", "[0, -0.8", "cannot rest 0.010 m"),
    "same name twice": ("can:", "table:", "table", "`table` is both a fixture and a part"),
    "unknown body named as a part": ("crate:", "can:", "can", "`can` is both an unknown body and a part"),
    "unknown body named as a person": ("crate:", "anna:", "anna", "`anna` is both an unknown body and a person"),
    "unknown body with two lengths": ("[0.2, 0.2, 0.2]", "[0.2, 0.2]", "[0.2, 0.2]", "has 3 lengths, not 2"),
    "weightless unknown body": ("[0.2, 0.2, 0.2],", "[0.2, 0.2, 0.2], mass_kg: 0,", "0,", "Mass in kilograms"),
    "region outside the map": (
        "unknown_bodies:",
        "occupancy: {center_m: [0, 0, 0], size_m: [1, 1, 1], "
        "must_cover: {a: {center_m: [0, 0, 0.4], size_m: [1, 1, 1]}}}"
        "\nunknown_bodies:",
        "{center_m",
        "the region a extends 0.400 m beyond the box of the map",
    ),
    "region without a camera": (
        "unknown_bodies:",
        "occupancy: {center_m: [0, 0, 0], size_m: [1, 1, 1], "
        "must_cover: {a: {center_m: [0, 0, 0], size_m: [1, 1, 1]}}}"
        "\nunknown_bodies:",
        "must_cover",
        "regions must be covered, but the cell has no camera",
    ),
    "calibration of a cell": ("parts:", "calibration: a.yaml\nparts:", "calibration", "give it to the robot"),
    "no time for services": ("parts:", "bus: {service_timeout_s: 0}\nparts:", "0}", "> 0"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_cell_is_refused_where_the_mistake_stands(tmp_path: Path, name: str) -> None:
    """One line with file, line and column of the offending text."""
    old, new, at, says = WRONG[name]
    assert old in SMALL
    file = tmp_path / "cell.yaml"
    file.write_text(SMALL.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(DocumentError) as refusal:
        load_cell(file)
    assert says in str(refusal.value)
    where = refusal.value.where
    assert isinstance(where, Position)
    assert file.read_text(encoding="utf-8").splitlines()[where.line - 1][where.column - 1 :].startswith(at)


def test_the_demo_cell_is_valid() -> None:
    """Two simulated arms, parts to carry, and a seed file beside the cells."""
    cell = load_cell(DEMO)
    assert set(cell.document.robots) == {"left", "right"}
    assert all(robot.simulated for robot in cell.document.robots.values())
    assert cell.seed_file == DEMO.parents[1] / "entries" / "dual_panda.yaml"


def test_paths_are_relative_to_the_document_except_the_database(tmp_path: Path) -> None:
    """The store is written where the program runs, everything else lies beside the cell."""
    file = tmp_path / "cells" / "cell.yaml"
    file.parent.mkdir()
    file.write_text(SMALL, encoding="utf-8")
    cell = load_cell(file)
    assert cell.seed_file == tmp_path / "entries" / "small.yaml"
    assert isinstance(cell.document.store, SqliteStoreSpec)
    assert cell.document.store.path == "data/cell.db"


def test_a_store_may_be_on_a_server(tmp_path: Path) -> None:
    """Its password is the name of an environment variable."""
    file = tmp_path / "cell.yaml"
    store = "store: {kind: mongodb, uri: 'mongodb://cell:${CELL_PASSWORD}@db:27017', seed: e.yaml}"
    file.write_text(re.sub("store: .*", store, SMALL), encoding="utf-8")
    cell = load_cell(file)
    uri = "mongodb://cell:${CELL_PASSWORD}@db:27017"
    assert cell.document.store == MongoStoreSpec(uri=uri, database="flexcell", seed="e.yaml")
    assert cell.seed_file == tmp_path / "e.yaml"


@pytest.mark.parametrize(
    ("store", "says"),
    [
        ("{kind: mongodb, uri: 'mongodb://cell:secret@db'}", "the `uri` of the store contains a password"),
        ("{kind: mongodb, uri: 'http://db'}", "uri"),
        ("{kind: mongodb, uri: 'mongodb://db', database: 'a b'}", "database"),
        ("{kind: mongo, uri: 'mongodb://db'}", "kind"),
    ],
)
def test_a_store_that_cannot_be_meant_is_refused(tmp_path: Path, store: str, says: str) -> None:
    """A secret in the file, another protocol, a name that no database has."""
    file = tmp_path / "cell.yaml"
    file.write_text(re.sub("store: .*", f"store: {store}", SMALL), encoding="utf-8")
    with pytest.raises(DocumentError, match=says):
        load_cell(file)


def test_a_driver_of_its_own_keeps_its_options(tmp_path: Path) -> None:
    """The table's other keys belong to the driver."""
    file = tmp_path / "cell.yaml"
    file.write_text(
        SMALL.replace("model: panda,", "model: ur10, driver: {kind: ur_rtde, host: 127.0.0.5},"), encoding="utf-8"
    )
    robot = load_cell(file).document.robots["left"]
    assert (robot.driver_kind, robot.driver, robot.simulated) == (
        "ur_rtde",
        {"kind": "ur_rtde", "host": "127.0.0.5"},
        False,
    )


@pytest.mark.parametrize(
    ("rpy", "xyzw"),
    [
        ((0.0, 0.0, math.pi / 2), (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))),
        ((math.pi, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
        ((0.0, math.pi / 2, math.pi / 2), (-0.5, 0.5, 0.5, 0.5)),
        # About fixed axes: first x, then z; a turn of x stays, and the result is not that of z then x.
        ((math.pi / 2, 0.0, math.pi / 2), (0.5, 0.5, 0.5, 0.5)),
    ],
)
def test_a_placement_turns_about_fixed_axes_in_turn(
    rpy: tuple[float, float, float], xyzw: tuple[float, float, float, float]
) -> None:
    """Roll about x, then pitch about y, then yaw about z, all axes of the world."""
    pose = Placement(xyz=(1.0, 2.0, 3.0), rpy=rpy).pose()
    assert (pose.xyz, pose.frame) == ((1.0, 2.0, 3.0), "world")
    assert pose.xyzw == pytest.approx(xyzw)


def test_a_person_needs_a_world(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(
        "flexcell: 1\ncell: a\npeople:\n  anna: {shoulder: [0, 0, 0], hand_rests: [0, 0, 0.3]}\n", encoding="utf-8"
    )
    with pytest.raises(DocumentError, match="person `anna` is simulated, but the cell has no world"):
        load_cell(file)
