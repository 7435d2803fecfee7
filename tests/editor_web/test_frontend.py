"""The front end: its own unit tests, its layers, what is built of it, and what the first page weighs."""

from __future__ import annotations

import gzip
import hashlib
import json
import re
from pathlib import Path

import pytest

import hatch_build

SOURCES = hatch_build.SOURCE / "src"
FILES = sorted(p for p in SOURCES.rglob("*.ts*") if not p.name.endswith((".test.ts", ".test.tsx", ".d.ts")))
IMPORT = re.compile(r"""(?:from|import\()\s*['"](\.[^'"]+)['"]""")
INITIAL_LIMIT_BYTES = 180_000
# What each floor may stand on, besides itself.
FLOORS = {
    "document": {"document", "api/types"},
    "api": {"api", "document"},
    "components": {"components", "api", "document"},
    "features": {"components", "api", "document"},
    "app": {"app", "features", "components", "api", "document"},
}


def imports(file: Path) -> list[str]:
    """The modules of ours that a file imports, relative to the sources, without their ending."""
    found: list[str] = IMPORT.findall(file.read_text(encoding="utf-8"))
    return [(file.parent / name).resolve().relative_to(SOURCES).as_posix() for name in found]


def test_its_unit_tests_pass() -> None:
    """Pure functions in `*.test.ts`; in `*.test.tsx` components, with a faked server and without a browser."""
    hatch_build.install()
    hatch_build.npm("test")


def test_the_built_page_is_current() -> None:
    """Else run `python hatch_build.py`."""
    assert hatch_build.DIGEST.read_text(encoding="ascii") == hatch_build.source_digest()


def test_packages_that_a_link_leads_to_are_never_emptied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`npm ci` empties the folder that it finds, wherever that is."""
    source, elsewhere = tmp_path / "frontend", tmp_path / "elsewhere"
    source.mkdir()
    elsewhere.mkdir()
    (source / "package-lock.json").write_text("{}", encoding="utf-8")
    (source / "node_modules").symlink_to(elsewhere)
    called: list[tuple[str, ...]] = []

    def npm(*arguments: str) -> None:
        called.append(arguments)

    monkeypatch.setattr(hatch_build, "SOURCE", source)
    monkeypatch.setattr(hatch_build, "npm", npm)
    with pytest.raises(RuntimeError, match=r"is a link to .*elsewhere.*: remove the link"):
        hatch_build.install()
    (elsewhere / ".lock-digest").write_text(hashlib.sha256(b"{}").hexdigest(), encoding="ascii")
    hatch_build.install()
    assert called == []


def test_it_passes_its_linter() -> None:
    """The rules of `.oxlintrc.json`, with types: hooks, promises, accessibility, `any`, exports, cycles."""
    hatch_build.install()
    hatch_build.npm("run", "lint")


def test_imports_go_downwards_and_features_never_import_one_another() -> None:
    """app over features over components over api over document."""
    wrong: list[str] = []
    for file in FILES:
        place = file.relative_to(SOURCES).parts
        allowed = FLOORS.get(place[0], set())
        for target in imports(file):
            own_feature = place[0] == "features" and target.startswith(f"features/{place[1]}/")
            if not own_feature and not any(target == floor or target.startswith(f"{floor}/") for floor in allowed):
                wrong.append(f"{'/'.join(place)} may not import {target}")
    assert wrong == []


def test_each_file_says_what_it_is_for() -> None:
    """In its first line."""
    marks = ("/**", "// Made by", "/// <reference")
    assert [f.name for f in FILES if not f.read_text(encoding="utf-8").startswith(marks)] == []


def test_what_documents_name_is_looked_up_in_a_dict() -> None:
    """`record[name]` also finds what every object inherits; `Dict` of document/dict.ts does not compile so."""
    exempt = {"structuralSharing.ts", "elements.ts"}
    named = [file for file in FILES if "Record<string, unknown>" in file.read_text(encoding="utf-8")]
    assert [file.name for file in named if file.name not in exempt] == []


def test_what_is_built_is_for_use_and_not_for_development() -> None:
    """There every element looks whether it is used rightly: half as fast, and larger."""
    scripts = [file.read_text(encoding="utf-8") for file in (hatch_build.STATIC / "assets").glob("*.js")]
    assert len(scripts) > 20
    assert not [text[:80] for text in scripts if "jsxDEV" in text or 'a unique "key" prop' in text]


def test_the_first_page_is_light() -> None:
    """All scripts that it loads at once, compressed."""
    manifest = json.loads((hatch_build.STATIC / ".vite" / "manifest.json").read_text(encoding="utf-8"))
    wanted, needed = ["index.html"], set[str]()
    while wanted:
        name = wanted.pop()
        if name not in needed:
            needed.add(name)
            wanted += manifest[name].get("imports", [])
    sizes = [len(gzip.compress((hatch_build.STATIC / manifest[name]["file"]).read_bytes())) for name in needed]
    assert 50_000 < sum(sizes) <= INITIAL_LIMIT_BYTES


def test_the_page_loads_nothing_from_elsewhere() -> None:
    """It works without any network."""
    page = (hatch_build.STATIC / "index.html").read_text(encoding="utf-8")
    assert re.findall(r"""(?:src|href)=["'](?!/)""", page) == []
    for sheet in (hatch_build.STATIC / "assets").glob("*.css"):
        assert re.findall(r"url\(['\"]?(?:https?:)?//", sheet.read_text(encoding="utf-8")) == []


def test_the_lock_file_names_no_download_host() -> None:
    """So it installs from whatever mirror is configured."""
    lock = json.loads((hatch_build.SOURCE / "package-lock.json").read_text(encoding="utf-8"))
    assert [name for name, package in lock["packages"].items() if "resolved" in package] == []
    assert all("integrity" in package for name, package in lock["packages"].items() if name)


def test_versions_are_exact() -> None:
    """An install today and one in a year are the same."""
    package = json.loads((hatch_build.SOURCE / "package.json").read_text(encoding="utf-8"))
    versions = {**package["dependencies"], **package["devDependencies"]}
    assert [name for name, version in versions.items() if not re.fullmatch(r"\d+\.\d+\.\d+", version)] == []
