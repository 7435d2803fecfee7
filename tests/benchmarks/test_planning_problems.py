"""Problems as MoveIt writes them are read from the file that ships them, with the arm that they are for."""

from __future__ import annotations

import bz2
import gzip
import io
import tarfile
from pathlib import Path

import pytest

from benchmarks.planning import problem_lines
from benchmarks.planning_problems import problem_sets
from engine.messages.shapes import Box, Cylinder, Sphere

JOINTS = 7
LINK = '<link name="{0}"><collision><geometry><box size="0.05 0.05 0.08"/></geometry></collision></link>'
JOINT = (
    '<joint name="panda_joint{0}" type="revolute"><parent link="{1}"/><child link="{2}"/>'
    '<origin xyz="0 0 0.1"/><axis xyz="{3}"/><limit lower="-3" upper="3" velocity="2" effort="80"/></joint>'
)
SCENE = """\
world:
  collision_objects:
    - id: shelf
      primitives:
        - {type: box, dimensions: [0.2, 0.3, 0.1]}
        - {type: cylinder, dimensions: [0.14, 0.03]}
      primitive_poses:
        - {position: [1.0, 0.0, 0.0], orientation: [0, 0, 0.7071, 0.7071]}
        - {position: [1.0, 0.5, 0.0], orientation: [0, 0, 0, 1]}
      pose: {position: [0, 0, 0.2], orientation: [0, 0, 0, 1]}
    - id: ball
      primitives: [{type: sphere, dimensions: [0.1]}]
      primitive_poses: [{position: BALL, orientation: [0, 0, 0, 1]}]
"""
REQUEST = """\
start_state:
  joint_state:
    name: [panda_finger_joint1, NAMES]
    position: [0.065, 0, 0.2, 0, -0.5, 0, 0.5, 0]
goal_constraints:
  - joint_constraints: [GOALS]
"""


def urdf() -> str:
    names = [f"panda_link{k}" for k in range(JOINTS)] + ["panda_hand"]
    axes = ("0 0 1", "0 1 0")
    joints = [JOINT.format(k, names[k - 1], names[k], axes[(k - 1) % 2]) for k in range(1, JOINTS + 1)]
    return f'<robot name="panda">{"".join(LINK.format(name) for name in names)}{"".join(joints)}</robot>'


def packed(files: dict[str, str | bytes]) -> bytes:
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w") as archive:
        for name, text in files.items():
            content = text.encode() if isinstance(text, str) else text
            member = tarfile.TarInfo(name)
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    return out.getvalue()


@pytest.fixture(name="file", scope="module")
def _file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    names = ", ".join(f"panda_joint{k}" for k in range(1, JOINTS + 1))

    def request(first: float) -> str:
        values = [first, 0.2, 0.0, -0.5, 0.0, 0.5, 0.0]
        goals = ", ".join(f"{{joint_name: panda_joint{k}, position: {v}}}" for k, v in enumerate(values, start=1))
        return REQUEST.replace("NAMES", names).replace("GOALS", goals)

    free, touching = (SCENE.replace("BALL", at) for at in ("[0, 0, 1.5]", "[0, 0, 0.4]"))
    problems = packed(
        {
            "problems/shelf_panda/scene0001.yaml": free,
            "problems/shelf_panda/request0001.yaml": request(1.5),
            "problems/shelf_panda/scene0002.yaml": touching,
            "problems/shelf_panda/request0002.yaml": request(1.5),
            "problems/shelf_panda/scene0003.yaml": free,
            "problems/shelf_panda/request0003.yaml": request(3.1),
        }
    )
    top = "vamp_planner-0.0.0"
    content = packed(
        {
            f"{top}/LICENSE.txt": "free",
            f"{top}/resources/panda/panda.urdf": urdf(),
            f"{top}/resources/panda/panda.srdf": '<robot name="panda"/>',
            f"{top}/resources/panda/problems.tar.bz2": bz2.compress(problems),
        }
    )
    file = tmp_path_factory.mktemp("problems") / "vamp.tar.gz"
    file.write_bytes(gzip.compress(content))
    return file


def test_sets_have_the_problems_with_free_ends_and_say_how_many_were_left_out(file: Path, tmp_path: Path) -> None:
    (found,) = problem_sets(file, tmp_path / "arm")
    assert (found.name, len(found.cases), found.touching, found.outside) == ("shelf", 1, 1, 1)
    request = found.cases[0].request
    assert request.start_rad == (0.0, 0.2, 0.0, -0.5, 0.0, 0.5, 0.0)
    shelf, ball = request.scene.obstacles
    assert [solid.shape for solid in shelf.solids] == [
        Box(size_m=(0.2, 0.3, 0.1)),
        Cylinder(radius_m=0.03, length_m=0.14),
    ]
    assert shelf.solids[0].pose.xyz == (1.0, 0.0, 0.2)
    assert ball.solids[0].shape == Sphere(radius_m=0.1)


def test_every_problem_is_planned(file: Path) -> None:
    ((line,),) = problem_lines(file, ("fast",))
    assert (line.runs, line.found, line.exact) == (1, 1, 1)
    assert line.case == "shelf, 2 left out, 1 s"


def test_another_archive_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "other.tar.gz"
    file.write_bytes(gzip.compress(packed({"a.txt": "a"})))
    with pytest.raises(KeyError):
        list(problem_sets(file, tmp_path / "arm"))
