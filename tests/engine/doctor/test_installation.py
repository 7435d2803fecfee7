"""What is told of packages: of the base, of extras, of versions, and of what has no wheel here."""

from __future__ import annotations

import pytest

from engine.doctor.examination import Examination
from engine.doctor.installation import extras, installation

REQUIRES = (
    "msgspec>=0.20,<0.30",
    "pymodbus==3.16.*; extra == 'robotiq'",
    "pyserial>=3.5; extra == 'robotiq'",
    "ur-rtde==1.6.5; (python_version < '3.0') and extra == 'ur'",
    "flexcell[robotiq]; extra == 'all'",
    "pytest>=9; extra == 'test'",
)
ALL = {"msgspec": "0.21", "pymodbus": "3.16.1", "pyserial": "3.5"}


def examined(**versions: str | None) -> dict[str, Examination]:
    """Return what is told with these versions installed, None for none, by subject."""
    installed: dict[str, str | None] = {**ALL, **versions}
    return {each.subject: each for each in extras(REQUIRES, installed.get)}


def test_what_is_installed_is_ok_and_extras_of_developers_are_left_out() -> None:
    found = examined()
    assert {name: each.condition for name, each in found.items()} == {
        "base": "ok",
        "extra robotiq": "ok",
        "extra ur": "note",
    }
    assert found["extra ur"].state == "no wheel for this Python or machine: ur-rtde"
    assert found["extra ur"].advice == ""


@pytest.mark.parametrize(
    ("versions", "state"),
    [({"pymodbus": None}, "missing: pymodbus"), ({"pymodbus": None, "pyserial": None}, "not installed")],
)
def test_an_extra_that_is_missing_is_a_note_with_the_command(versions: dict[str, None], state: str) -> None:
    found = examined(**versions)["extra robotiq"]
    assert (found.condition, found.state, found.advice) == ("note", state, "pip install 'flexcell[robotiq]'")


def test_another_version_is_a_problem_also_of_an_extra() -> None:
    found = examined(pymodbus="3.15.0")["extra robotiq"]
    assert (found.condition, found.state) == ("problem", "pymodbus 3.15.0 instead of ==3.16.*")


def test_a_base_without_a_package_is_a_problem() -> None:
    found = examined(msgspec=None)["base"]
    assert (found.condition, found.state) == ("problem", "missing: msgspec")


def test_this_installation_is_complete() -> None:
    found = {each.subject: each for each in installation()}
    assert (found["base"].condition, found["extra sim"].condition) == ("ok", "ok")
    assert "Python 3." in found["flexcell"].state
