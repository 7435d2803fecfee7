"""What all runs of a sweep have in common."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.sweep import parse_sweep
from engine.errors import ControlError, DocumentError
from engine.sweep.subject.cell_variation import varied_cell
from engine.sweep.subject.sweep_subject import SweepSubject, other_versions, package_versions
from tests.engine.sweep.luck_project import LuckProject

CELL = """\
flexcell: 1
cell: table
world: {kind: mujoco}
parts:
  bolt: {shape: cylinder, size_m: [0.01, 0.05], mass_kg: 0.2, at: {xyz: [0.1, 0.2, 0.3]}}
"""
FAULTS = "flexcell: 1\nfaults: [{at: root/only, error: broken}]\n"


@pytest.fixture
def project(tmp_path: Path) -> LuckProject:
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    (tmp_path / "slip.yaml").write_text(FAULTS, encoding="utf-8")
    return LuckProject(tmp_path)


def _subject(project: LuckProject, **keys: object) -> SweepSubject:
    return SweepSubject.load(project.sweep(**{"cell": "cell.yaml", **keys}))


def test_the_nominal_value_is_that_of_the_behavior_or_the_cell(project: LuckProject) -> None:
    factors = {
        "parameters.rate": {"uniform": [0.0, 1.0]},
        "parameters.luck": {"uniform": [0.0, 1.0], "nominal": 0.25},
        "displace.bolt.x_m": {"uniform": [0.0, 0.1]},
        "cell.parts.bolt.mass_kg": {"uniform": [0.0, 4.0]},
        "cell.parts.bolt.at.xyz.1": {"uniform": [0.0, 4.0]},
        "cell.parts.bolt.jitter.xy_m": {"uniform": [0.0, 0.01]},
        "faults": {"values": ["slip.yaml", "none"]},
    }
    assert _subject(project, factors=factors).nominal == {
        "parameters.rate": 0.5,
        "parameters.luck": 0.25,
        "displace.bolt.x_m": 0.0,
        "cell.parts.bolt.mass_kg": 0.2,
        "cell.parts.bolt.at.xyz.1": 0.2,
        "cell.parts.bolt.jitter.xy_m": 0.005,
        "faults": "slip.yaml",
    }


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("luck.yaml", "default: 0.5", "default: 0.6"),
        ("cell.yaml", "mass_kg: 0.2", "mass_kg: 0.3"),
        ("slip.yaml", "broken", "torn"),
        ("", "done", "done "),
    ],
)
def test_every_document_and_state_is_part_of_the_hash(project: LuckProject, file: str, old: str, new: str) -> None:
    keys: dict[str, object] = {"faults": "slip.yaml"}
    before = _subject(project, **keys).hash
    path = project.path / (file or f"{project.module}.py")
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(f"{text}\n# {new}\n" if not file else text.replace(old, new), encoding="utf-8")
    assert _subject(project, **keys).hash != before


def test_what_a_state_imports_of_its_project_is_part_of_the_hash(project: LuckProject) -> None:
    """Loaded anew: Python imports a module once."""
    tools, module = project.path / "tools_of_luck.py", project.path / f"{project.module}.py"
    tools.write_text("LIMIT = 3\n", encoding="utf-8")
    module.write_text(f"import tools_of_luck\n{module.read_text(encoding='utf-8')}", encoding="utf-8")
    before = _subject(project)
    tools.write_text("LIMIT = 4\n", encoding="utf-8")
    assert other_versions(_subject(project).versions, before.versions) == "states"


def test_a_model_beside_the_cell_is_part_of_the_hash(project: LuckProject) -> None:
    model = project.path / "mine" / "robot.yaml"
    model.parent.mkdir()
    model.write_text("flexcell: 1\n", encoding="utf-8")
    (project.path / "cell.yaml").write_text(f"{CELL}robots: {{left: {{model: ./mine}}}}\n", encoding="utf-8")
    before = _subject(project)
    model.write_text("flexcell: 1\nname: other\n", encoding="utf-8")
    assert other_versions(_subject(project).versions, before.versions) == "models"


def test_versions_that_differ_are_named() -> None:
    assert other_versions({"a": "1.0", "c": "2", "s": "0" * 64}, {"a": "1.1", "s": "1" * 64}) == (
        "a 1.0 instead of 1.1, c 2 instead of none, s"
    )
    assert other_versions({}, {"a": "1"}) == "a missing instead of 1"


def test_comments_and_the_design_are_no_part_of_it(project: LuckProject) -> None:
    before = _subject(project).hash
    project.behavior.write_text(f"# A comment.\n{project.behavior.read_text(encoding='utf-8')}", encoding="utf-8")
    assert _subject(project, runs=7, seed=3, design="sobol", timeout="9 s", require="success >= 1").hash == before
    assert _subject(project, parameters={"rate": 0.1}).hash != before
    assert _subject(project, placement_noise=False).hash != before


def test_packages_that_only_tests_need_are_no_part_of_it() -> None:
    found = package_versions()
    assert {"flexcell", "msgspec", "mujoco"} <= set(found)
    assert not {"pytest", "ruff", "fastapi"} & set(found)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"factors": {"parameters.lucky": {"values": [1]}}}, "the behavior has no parameter `lucky`.*luck"),
        ({"factors": {"displace.nut.x_m": {"values": [1]}}}, "the cell has no part `nut`"),
        ({"factors": {"cell.parts.bolt.mas_kg": {"values": [1]}}}, "unknown key `mas_kg`"),
        ({"factors": {"faults": {"values": ["none", "no.yaml"]}}}, "no.yaml.*cannot read this file"),
        ({"cell": "no.yaml"}, "no.yaml.*cannot read this file"),
        ({"store": "no.db"}, "there is no store"),
    ],
)
def test_what_names_nothing_is_refused(project: LuckProject, keys: dict[str, object], message: str) -> None:
    with pytest.raises(DocumentError, match=message):
        _subject(project, **keys)


def test_a_cell_factor_needs_a_cell(project: LuckProject) -> None:
    text = '{"flexcell": 1, "behavior": "luck.yaml", "factors": {"displace.bolt.x_m": {"values": [1]}}}'
    with pytest.raises(DocumentError, match=r"`displace.bolt.x_m` needs a cell"):
        SweepSubject.load(parse_sweep(text, file=project.path / "s.yaml"))


REAL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: ur10, gripper: {model: robotiq_2f85, driver: {kind: nowhere}}}
"""


def test_a_sweep_drives_no_real_device_unless_it_is_simulated(project: LuckProject) -> None:
    (project.path / "real.yaml").write_text(REAL, encoding="utf-8")
    with pytest.raises(
        ControlError, match=r"a sweep drives no real devices, and these of bench are real: left/gripper"
    ):
        _subject(project, cell="real.yaml")
    subject = _subject(project, cell="real.yaml", simulate=["all"])
    assert subject.cell is not None
    assert subject.cell.document.real_devices == {}
    # A factor makes another cell of it, in which the device is simulated all the same.
    varied = varied_cell(subject.cell, {"cell.world.realism": "ideal"})
    assert (varied.document.real_devices, dict(varied.simulated)) == ({}, {"left/gripper": "nowhere"})


def test_no_factor_makes_a_device_real(project: LuckProject) -> None:
    (project.path / "sim.yaml").write_text(REAL.replace("{kind: nowhere}", "sim"), encoding="utf-8")
    cell = _subject(project, cell="sim.yaml").cell
    assert cell is not None
    with pytest.raises(DocumentError, match="a factor gives `left/gripper` the driver `nowhere`"):
        varied_cell(cell, {"cell.robots.left.gripper.driver": {"kind": "nowhere"}})


def test_what_is_simulated_tells_versions_apart(project: LuckProject) -> None:
    (project.path / "real.yaml").write_text(REAL, encoding="utf-8")
    sim = REAL.replace("{kind: nowhere}", "sim")
    (project.path / "sim.yaml").write_text(sim, encoding="utf-8")
    simulated = _subject(project, cell="real.yaml", simulate=["left/gripper"])
    assert simulated.versions["cell"] == _subject(project, cell="sim.yaml").versions["cell"]
