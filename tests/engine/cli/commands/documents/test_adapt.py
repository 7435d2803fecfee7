"""`flexcell adapt`: a behavior of another cell is mapped, checked, and written only where a file is given."""

from __future__ import annotations

from pathlib import Path

from engine.document import load_behavior
from tests.engine.cli.command import flexcell

CELL = "flexcell: 1\ncell: {name}\nworld: {{kind: mujoco}}\nrobots: {{{arm}: {{model: panda}}}}\n"
WORK = """\
flexcell: 1
name: work
cell: old.yaml
outcomes: [good, bad]
success: [good]
root:
  state: motion.MoveJoints
  with: {robot: left, target: {entry: home}, speed: 0.1}   # slowly
"""


def test_a_behavior_is_mapped_and_written(tmp_path: Path) -> None:
    (tmp_path / "old.yaml").write_text(CELL.format(name="old", arm="left"))
    (tmp_path / "new.yaml").write_text(CELL.format(name="new", arm="arm"))
    (tmp_path / "work.yaml").write_text(WORK.replace("[good, bad]", "[reached, failed]").replace("[good]", "[reached]"))
    said = flexcell("adapt", "work.yaml", "--cell", "new.yaml", cwd=tmp_path)
    assert said.code == 0, said.err
    assert said.out.splitlines() == [
        "+ robot left -> arm (same tool and joints)",
        "- joints home: stays, new has no joints entry",
    ]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["new.yaml", "old.yaml", "work.yaml"]
    arguments = ("--map", "joints:home=rest", "--name", "rest", "-o", "made/rest.yaml")
    said = flexcell("adapt", "work.yaml", "--cell", "new.yaml", *arguments, cwd=tmp_path)
    assert (said.code, said.err.splitlines()[-1]) == (0, "wrote made/rest.yaml"), said.err
    assert (
        "with: {robot: arm, target: {entry: rest}, speed: 0.1}   # slowly" in (tmp_path / "made/rest.yaml").read_text()
    )
    assert load_behavior(tmp_path / "made/rest.yaml").cell_file == tmp_path / "new.yaml"
    again = flexcell("adapt", "work.yaml", "--cell", "new.yaml", "-o", "made/rest.yaml", cwd=tmp_path)
    assert (again.code, "there is a file of this name" in again.err) == (2, True)
    wrong = flexcell("adapt", "work.yaml", "--cell", "new.yaml", "--map", "lift=arm", cwd=tmp_path)
    assert (wrong.code, "the behavior uses no `lift` of its cell" in wrong.err) == (2, True)
