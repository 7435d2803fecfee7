"""Which modules the file of a state imports."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.sweep.subject.source_files import SourceFile, with_imports

FILES = {
    "cell/__init__.py": "",
    "cell/settle.py": "import json, numpy\nfrom cell import tools\nfrom .limits import LIMIT\nimport engine.state\n",
    "cell/tools.py": "def use():\n    import shared.units as units\n    return units\n",
    "cell/limits.py": "from . import tools\nfrom .. import nothing\n",
    "cell/unused.py": "",
    "shared/units.py": "import cell.settle\nthis is no Python\n",
    "numpy_like/__init__.py": "",
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return tmp_path


def _found(folder: Path, projects: list[Path]) -> set[str]:
    start = [SourceFile("cell.settle", folder / "cell" / "settle.py")]
    return {file.relative_to(folder).as_posix() for file in with_imports(start, projects)}


def test_modules_of_the_project_are_followed_and_nothing_else(folder: Path) -> None:
    expected = {"cell/__init__.py", "cell/settle.py", "cell/tools.py", "cell/limits.py", "shared/units.py"}
    assert _found(folder, [folder]) == expected


def test_of_an_installed_package_only_its_own_modules_are(folder: Path) -> None:
    assert _found(folder, []) == {"cell/__init__.py", "cell/settle.py", "cell/tools.py", "cell/limits.py"}
