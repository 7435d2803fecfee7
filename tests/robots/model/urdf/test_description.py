"""Installed robot descriptions are found by a file that their package lists, however it lists its files."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from engine.errors import CellError
from robots.model.urdf.description import installed_share_dir

METADATA = "Metadata-Version: 2.1\nName: some-arms\nVersion: 1.0\n"
FILE = "share/some, arms/urdf/arm.urdf"


def install(site: Path, folder: str, *, listed: str, file: str = FILE) -> None:
    (site / folder).mkdir()
    metadata, listing = ("METADATA", "RECORD") if folder.endswith(".dist-info") else ("PKG-INFO", "SOURCES.txt")
    (site / folder / metadata).write_text(METADATA, encoding="utf-8")
    (site / folder / listing).write_text(listed, encoding="utf-8")
    (site / file).parent.mkdir(parents=True, exist_ok=True)
    (site / file).touch()


@pytest.mark.parametrize(
    ("folder", "listed"),
    [
        ("some_arms-1.0.dist-info", f'other.py,,\nshare/urdf/arm.urdf.txt,,\n"{FILE}",sha256=x,12\n'),
        ("some_arms.egg-info", f"setup.py\n{FILE}\n"),
    ],
)
def test_the_folder_around_a_listed_file_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: str, listed: str
) -> None:
    """Names may have commas in them."""
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    install(tmp_path, folder, listed=listed)
    assert installed_share_dir(package="some-arms", marker="urdf/arm.urdf") == (tmp_path / "share" / "some, arms")


def test_a_listed_file_that_is_gone_is_not_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    install(tmp_path, "some_arms-1.0.dist-info", listed=f'"{FILE}",,\n')
    (tmp_path / FILE).unlink()
    with pytest.raises(CellError, match=r"some-arms has no file urdf/arm\.urdf"):
        installed_share_dir(package="some-arms", marker="urdf/arm.urdf")
