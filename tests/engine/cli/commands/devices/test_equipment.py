"""`flexcell equipment`: the configuration of a served module's computer, read and replaced from the terminal."""

from __future__ import annotations

import re
from collections.abc import Generator
from pathlib import Path

import pytest

from tests.engine.cli.command import CommandOutput, flexcell
from tests.robots.drivers.equipment.served_equipment import SIMULATED, ServedEquipment, served_equipment
from tests.robots.own_address import own_address

DIGEST = re.compile(r"^digest (\w+)$", re.MULTILINE)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    file = tmp_path / "clamps.yaml"
    file.write_text(SIMULATED, encoding="utf-8")
    return file


@pytest.fixture
def server(file: Path) -> Generator[ServedEquipment]:
    with served_equipment(file) as served:
        yield served


HERE = Path()


def _ask(server: ServedEquipment, *arguments: str) -> CommandOutput:
    return flexcell("equipment", *arguments, "--connect", f"{server.host}:{server.port}", cwd=HERE)


def _digest(server: ServedEquipment) -> str:
    shown = _ask(server, "show")
    found = DIGEST.search(shown.err)
    assert found is not None, shown
    return found[1]


def test_a_configuration_is_replaced_and_taken_back(server: ServedEquipment, file: Path, tmp_path: Path) -> None:
    new = tmp_path / "new.yaml"
    new.write_text(SIMULATED.replace("pin: 27", "pin: 5"), encoding="utf-8")
    done = _ask(server, "set", str(new), "--base", _digest(server))
    assert (done.code, done.out) == (0, "clamps is served by the new configuration\n"), done
    assert file.read_text(encoding="utf-8") == new.read_text(encoding="utf-8")
    assert _ask(server, "rollback", "--base", _digest(server)).code == 0
    assert file.read_text(encoding="utf-8") == SIMULATED


def test_a_file_that_was_edited_is_read_anew(server: ServedEquipment, file: Path) -> None:
    file.write_text(SIMULATED.replace("pin: 27", "pin: 6"), encoding="utf-8")
    assert _ask(server, "restart").code == 0
    assert "pin: 6" in _ask(server, "show").out


def test_the_template_is_a_valid_document(server: ServedEquipment, tmp_path: Path) -> None:
    (tmp_path / "template.yaml").write_text(_ask(server, "template").out, encoding="utf-8")
    assert flexcell("check", "template.yaml", cwd=tmp_path).code == 0


def test_what_is_refused_changes_nothing_and_says_where(server: ServedEquipment, file: Path, tmp_path: Path) -> None:
    """A base that is outdated, and pins with two names."""
    new = tmp_path / "new.yaml"
    new.write_text(SIMULATED.replace("pin: 22", "pin: 17"), encoding="utf-8")
    outdated = _ask(server, "set", str(new), "--base", "0123")
    assert outdated.code == 2
    assert "the configuration was changed since you have read it" in outdated.err
    doubled = _ask(server, "set", str(new), "--base", _digest(server))
    assert doubled.code == 2
    assert "pin 17 of `valve` is that of `clamp`" in doubled.err
    assert file.read_text(encoding="utf-8") == SIMULATED


@pytest.mark.parametrize("address", ["nowhere", "127.0.0.1:", "127.0.0.1:99999"])
def test_an_address_that_is_none_is_refused(address: str) -> None:
    ended = flexcell("equipment", "show", "--connect", address, cwd=HERE)
    assert ended.code == 2
    assert f"`{address}` is no address" in ended.err


def test_nobody_listening_is_one_line() -> None:
    ended = flexcell("equipment", "show", "--connect", f"{own_address()}:9", cwd=HERE)
    assert ended.code == 2
    assert "cannot connect" in ended.err
    assert "see whether `flexcell equipment serve` runs there" in ended.err
    assert "Traceback" not in ended.err
