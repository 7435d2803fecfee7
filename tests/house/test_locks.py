"""What is installed is what the lock files name, by version and hash, and they fit `pyproject.toml`."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

import bootstrap
import hatch_build

LOCKS = [bootstrap.LOCKS / f"{name}.lock" for name in bootstrap.LOCKED]
PROJECT: dict[str, Any] = tomllib.loads(bootstrap.PROJECT.read_text(encoding="utf-8"))
# Where it is installed: CPython on Linux x86-64.
MACHINE = {"sys_platform": "linux", "platform_machine": "x86_64", "platform_system": "Linux", "os_name": "posix"}
PYTHONS = ("3.11", "3.12", "3.13")
EXTRAS = {"runtime": ["all"], "development": ["all", "test", "bench"]}
GROUPS = {"runtime": ["build"], "development": ["build", "lock", "audit"]}


def entries(lock: Path) -> list[str]:
    """Each locked package with its hashes, in one line, without comments."""
    lines = [line for line in lock.read_text(encoding="utf-8").splitlines() if not line.lstrip().startswith("#")]
    return "\n".join(lines).replace("\\\n", " ").splitlines()


def pins(lock: Path, python: str = "") -> dict[str, Version]:
    """The version of each package, on one Python."""
    found: dict[str, Version] = {}
    for entry in entries(lock):
        requirement = Requirement(entry.partition(" --hash")[0])
        if requirement.marker is None or requirement.marker.evaluate(machine(python)):
            (specifier,) = requirement.specifier
            found[canonicalize_name(requirement.name)] = Version(specifier.version)
    return found


def machine(python: str) -> dict[str, str]:
    """What markers ask for, on one Python."""
    return MACHINE | {"python_version": python, "python_full_version": f"{python}.0"}


def required(name: str) -> list[Requirement]:
    """Everything that the project asks for in a lock, the extras that name other extras followed."""
    texts = [*PROJECT["project"]["dependencies"], *PROJECT["build-system"]["requires"]]
    wanted = list(EXTRAS[name])
    while wanted:
        for text in PROJECT["project"]["optional-dependencies"][wanted.pop()]:
            requirement = Requirement(text)
            if requirement.name == PROJECT["project"]["name"]:
                wanted.extend(requirement.extras)
            else:
                texts.append(text)
    for group in GROUPS[name]:
        texts += PROJECT["dependency-groups"][group]
    return [Requirement(text) for text in texts]


@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.stem)
def test_each_package_is_one_version_with_hashes_and_without_an_address(lock: Path) -> None:
    """Nothing in it says where a package comes from, so it works behind any registry."""
    text = lock.read_text(encoding="utf-8")
    assert "://" not in text
    assert "--index-url" not in text
    assert len(entries(lock)) > 50
    for entry in entries(lock):
        assert re.fullmatch(r"[a-z0-9-]+(\[\S+\])?==\S+( ; .+?)?( +--hash=sha256:[0-9a-f]{64})+", entry), entry


@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.stem)
def test_it_was_made_for_what_the_project_requires(lock: Path) -> None:
    """Else run `python3 bootstrap.py lock`."""
    bootstrap.require_current_lock(bootstrap.PROJECT, lock)


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.stem)
def test_what_is_locked_is_what_is_required(lock: Path, python: str) -> None:
    """For each Python, by its markers."""
    locked = pins(lock, python)
    for requirement in required(lock.stem):
        if requirement.marker is None or requirement.marker.evaluate(machine(python)):
            assert locked[canonicalize_name(requirement.name)] in requirement.specifier, requirement


@pytest.mark.parametrize("python", PYTHONS)
def test_the_demo_runs_on_the_versions_that_are_tested(python: str) -> None:
    """What the one lock holds, the other holds too."""
    runtime, development = (pins(bootstrap.LOCKS / f"{name}.lock", python) for name in ("runtime", "development"))
    assert runtime.items() <= development.items()


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('"httpx>=0.28"', '"httpx>=0.29"'),
        ('"pymongo>=4.13,<5"', ""),
        ('requires = ["hatchling>=1.27"]', "requires = []"),
    ],
    ids=["a version", "an extra", "the build"],
)
def test_a_changed_requirement_is_reported(tmp_path: Path, before: str, after: str, capsys: Any) -> None:
    """By name of the lock, and with what to do."""
    text = bootstrap.PROJECT.read_text(encoding="utf-8")
    assert before in text
    changed = tmp_path / "pyproject.toml"
    changed.write_text(text.replace(before, after), encoding="utf-8")
    with pytest.raises(SystemExit):
        bootstrap.require_current_lock(changed, LOCKS[0])
    said = capsys.readouterr().err
    assert "requirements/development.lock does not fit the requirements in pyproject.toml" in said
    assert "python3 bootstrap.py lock" in said


def test_a_change_of_anything_else_asks_for_no_new_lock(tmp_path: Path) -> None:
    """As the settings of a linter."""
    changed = tmp_path / "pyproject.toml"
    text = bootstrap.PROJECT.read_text(encoding="utf-8")
    changed.write_text(text.replace("line-length = 120", "line-length = 100"), encoding="utf-8")
    for lock in LOCKS:
        bootstrap.require_current_lock(changed, lock)


def test_a_lock_that_is_missing_is_reported(tmp_path: Path) -> None:
    """And nothing is installed without one."""
    with pytest.raises(SystemExit):
        bootstrap.require_current_lock(bootstrap.PROJECT, tmp_path / "none.lock")


def test_uv_is_installed_first_by_its_own_entry_of_the_lock() -> None:
    """With all its hashes, and nothing of its neighbours."""
    (entry,) = [entry for entry in entries(LOCKS[0]) if entry.startswith("uv==")]
    alone = bootstrap.lock_entry(LOCKS[0], "uv")
    assert entry.count("--hash=sha256:") > 5
    assert (
        "\n".join(line for line in alone.splitlines() if "#" not in line).replace("\\\n", " ").strip() == entry.strip()
    )


@pytest.mark.parametrize(
    ("by_uv", "exit_code", "installers"),
    [(True, 0, ["pip", "uv"]), (True, 2, ["pip", "uv", "pip"]), (False, 0, ["pip"])],
    ids=["by uv", "uv fails", "by pip"],
)
def test_whoever_installs_does_it_by_hashes_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, by_uv: bool, exit_code: int, installers: list[str]
) -> None:
    """pip installs where uv fails, as behind a registry that only pip's settings name."""
    commands: list[list[str]] = []

    def run(command: list[object], **_options: object) -> SimpleNamespace:
        commands.append([str(part) for part in command])
        return SimpleNamespace(returncode=exit_code if "uv" in command else 0)

    monkeypatch.setattr(bootstrap, "VENV", tmp_path)
    monkeypatch.setattr("bootstrap.subprocess.run", run)
    bootstrap.install_locked(LOCKS[0], by_uv=by_uv)
    assert [command[2] for command in commands] == installers
    assert all(
        command[-5:-1] == ["--require-hashes", "--only-binary", ":all:", "--requirement"] for command in commands
    )
    assert commands[-1][-1] == str(LOCKS[0])


def test_a_package_that_a_lock_does_not_hold_is_reported(capsys: Any) -> None:
    """Not installed from elsewhere, without a hash."""
    with pytest.raises(SystemExit):
        bootstrap.lock_entry(LOCKS[0], "u")
    assert "development.lock has 0 entries of u" in capsys.readouterr().err


def test_each_package_of_the_page_has_a_hash_and_no_address() -> None:
    """`npm ci` installs what the lock file names, and checks it."""
    lock = json.loads((hatch_build.SOURCE / "package-lock.json").read_text(encoding="utf-8"))
    for name, package in lock["packages"].items():
        assert not name or re.fullmatch(r"sha512-[A-Za-z0-9+/]{86}==", package["integrity"]), name
        assert "resolved" not in package, name
