"""Whatever the page is built from comes with its licence, in the page and in the wheel."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

from hatchling.builders.wheel import WheelBuilder
from hatchling.metadata.core import CoreMetadata

import hatch_build

NAME = "THIRD-PARTY-NOTICES.txt"
RULE = "\n\n" + "=" * 80 + "\n\n"
# What the lock file has for use, and the bundle nothing of: types, and the drawings that an icon package is made of.
NOT_IN_BUNDLE = {"@tabler/icons", "csstype", "tagged-tag", "type-fest"}
# Tools whose code that loads other code comes with everything they build.
IN_EVERY_BUNDLE = {"vite", "rolldown"}
# Words that a licence has, whichever it is.
PERMISSIONS = (
    "Permission is hereby granted",
    "Permission to use, copy",
    "Redistribution and use",
    "FONT LICENSE",
    "Eclipse Public",
)


def notices() -> dict[str, str]:
    """The notice of each package and version."""
    sections = (hatch_build.STATIC / NAME).read_text(encoding="utf-8").split(RULE)[1:]
    return {section.partition("\n")[0]: section for section in sections}


def shipped() -> set[str]:
    """The packages and versions that the lock file has for use, and not only for building."""
    lock = json.loads((hatch_build.SOURCE / "package-lock.json").read_text(encoding="utf-8"))
    return {
        f"{path.rpartition('node_modules/')[2]} {package['version']}"
        for path, package in lock["packages"].items()
        if path and not package.get("dev")
    }


@cache
def wheel() -> tuple[WheelBuilder, frozenset[str]]:
    """What makes the wheel, and the paths of its files: walking over them takes two seconds."""
    builder = WheelBuilder(str(hatch_build.ROOT))
    return builder, frozenset(file.distribution_path for file in builder.recurse_included_files())


def name_of(title: str) -> str:
    """A package without its version."""
    return title.rpartition(" ")[0]


def test_each_package_of_the_bundle_has_its_notice() -> None:
    """None is left out, and none is there that the page has nothing of."""
    expected = {title for title in shipped() if name_of(title) not in NOT_IN_BUNDLE and not title.startswith("@types/")}
    found = {title for title in notices() if name_of(title) not in IN_EVERY_BUNDLE}
    assert found == expected
    assert {name_of(title) for title in notices()} >= IN_EVERY_BUNDLE


def test_a_notice_is_a_licence_with_its_whole_text() -> None:
    """Name and version, what kind of licence, and the words that give the permission."""
    for title, notice in notices().items():
        _, kind, text = notice.split("\n\n", 2)
        assert kind.startswith("Licence: "), title
        assert kind != "Licence: undefined", title
        assert len(text) > 600, title
        assert any(words.casefold() in text.casefold() for words in PERMISSIONS), title
        assert "copyright" in text.casefold(), title


def test_the_wheel_carries_all_licences() -> None:
    """Ours, those of the models, and that of the page, where tools look for them and beside the page."""
    builder, files = wheel()
    assert f"editor_web/static/{NAME}" in files
    assert "robots/arms/ur10/LICENSE" in files
    core: CoreMetadata = builder.metadata.core  # pyright: ignore[reportUnknownMemberType] - hatchling leaves it open
    assert set(core.license_files) == {
        "LICENSE",
        "robots/arms/ur10/LICENSE",
        f"editor_web/static/{NAME}",
    }


def test_the_wheel_has_no_other_files_of_others() -> None:
    """A font, a mesh or a picture that is added needs a notice first."""
    _, files = wheel()
    kinds = {Path(file).suffix for file in files}
    assert kinds <= {
        ".py",
        ".typed",
        ".yaml",
        ".md",
        ".pyi",
        ".html",
        ".json",
        ".urdf",
        ".txt",
        ".js",
        ".css",
        ".svg",
        ".ino",
        ".script",
        ".mod",
        ".woff2",
        "",
    }
