"""A behavior of another cell is adapted to the open one: first what would become of it, then the new document."""

from __future__ import annotations

from pathlib import Path

from engine.document.cell import load_cell
from tests.editor_web.editing_client import EditingClient

CELL = "flexcell: 1\ncell: {name}\nworld: {{kind: mujoco}}\nrobots: {{{arm}: {{model: panda}}}}\n"
WORK = """\
flexcell: 1
name: work
cell: old.yaml
outcomes: [reached, failed]
success: [reached]
root:
  state: motion.MoveJoints
  with: {robot: left, target: [0, 0, 0, -1, 0, 1, 0], speed: 0.1}   # slowly
"""
AT = "/documents/behaviors/work.yaml"


async def test_a_behavior_of_another_cell_is_adapted_to_the_open_one(tmp_path: Path) -> None:
    client = EditingClient(tmp_path)
    for name, text in {
        "old": CELL.format(name="old", arm="left"),
        "new": CELL.format(name="new", arm="arm"),
        "work": WORK,
    }.items():
        (tmp_path / "behaviors" / f"{name}.yaml").write_text(text)
    unknown = await client.post(f"{AT}/adaptation", {})
    assert (unknown.status_code, unknown.json()["message"]) == (422, "no cell is open")
    client.documents.cell = load_cell(tmp_path / "behaviors/new.yaml")
    planned = (await client.post(f"{AT}/adaptation", {})).json()
    assert (planned["id"], planned["name"]) == ("behaviors/work_new.yaml", "work_new")
    assert [(each["name"], each["target"]) for each in planned["plan"]["names"]] == [("left", "arm")]
    assert (planned["plan"]["findings"], planned["copies"]) == ([], [])
    assert not (tmp_path / planned["id"]).exists()
    body = {"id": planned["id"], "name": "lift", "names": {"robot:left": "arm"}}
    written = await client.post(f"{AT}/adapt", body)
    assert (written.status_code, written.json()["findings"]) == (201, [])
    assert (tmp_path / planned["id"]).read_text() == WORK.replace("name: work", "name: lift").replace(
        "old.yaml", "new.yaml"
    ).replace("left", "arm")
    again = await client.post(f"{AT}/adapt", body)
    assert (again.status_code, again.json()["message"]) == (422, "there is a document with this id")
