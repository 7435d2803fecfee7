"""What is installed of flexcell: its packages and those of its extras, by the metadata of the distribution."""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable, Iterable, Iterator
from importlib import metadata

from packaging.requirements import Requirement
from packaging.version import Version

from engine.doctor.examination import Examination

_DISTRIBUTION = "flexcell"
_OLDEST = (3, 11)
_GROUP = "installation"
_NOT_FOR_USERS = frozenset(("bench", "test"))
"""Extras that only the developers of flexcell install."""
VersionOf = Callable[[str], str | None]
"""Returns the version of an installed package, None if it is not installed."""


def installed_version(package: str) -> str | None:
    """Return the version of an installed package, None if it is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def installation() -> Iterator[Examination]:
    """Yield what is installed."""
    yield Examination(
        group=_GROUP,
        subject="flexcell",
        condition="ok",
        state=f"{metadata.version(_DISTRIBUTION)}, Python {platform.python_version()}, {platform.platform(terse=True)}",
    )
    if sys.version_info < _OLDEST:
        advice = "install Python 3.11 or newer"
        yield Examination(group=_GROUP, subject="Python", condition="problem", state="too old", advice=advice)
    yield from extras(metadata.requires(_DISTRIBUTION) or (), installed_version)


def extras(requires: Iterable[str], version_of: VersionOf) -> Iterator[Examination]:
    """Yield the state of the base and of each extra.

    Args:
        requires: Requirements as the metadata of a distribution have them, with markers.
        version_of: Looks a package up.
    """
    requirements = [Requirement(each) for each in requires]
    names = sorted({name for each in requirements for name in _extras_of(each)} - _NOT_FOR_USERS - {"all"})
    yield _state("base", [each for each in requirements if not _extras_of(each)], version_of)
    for name in names:
        yield _state(name, [each for each in requirements if name in _extras_of(each)], version_of)


def _state(name: str, requirements: list[Requirement], version_of: VersionOf) -> Examination:
    subject = name if name == "base" else f"extra {name}"
    missing, wrong, excluded, count = list[str](), list[str](), list[str](), 0
    for each in requirements:
        if each.name == _DISTRIBUTION:
            continue  # another extra, which has a line of its own
        if each.marker is not None and not each.marker.evaluate({"extra": "" if name == "base" else name}):
            excluded.append(each.name)
            continue
        count += 1
        version = version_of(each.name)
        if version is None:
            missing.append(each.name)
        elif not each.specifier.contains(Version(version), prereleases=True):
            wrong.append(f"{each.name} {version} instead of {each.specifier}")
    install = f"pip install '{_DISTRIBUTION}[{name}]'" if name != "base" else f"pip install --upgrade {_DISTRIBUTION}"
    if wrong or (missing and name == "base"):
        state = "; ".join([*wrong, *([f"missing: {', '.join(missing)}"] if missing else [])])
        return Examination(group=_GROUP, subject=subject, condition="problem", state=state, advice=install)
    if missing:
        state = "not installed" if len(missing) == count else f"missing: {', '.join(missing)}"
        return Examination(group=_GROUP, subject=subject, condition="note", state=state, advice=install)
    if excluded:
        state = f"no wheel for this Python or machine: {', '.join(excluded)}"
        return Examination(group=_GROUP, subject=subject, condition="note", state=state)
    return Examination(group=_GROUP, subject=subject, condition="ok", state="installed")


def _extras_of(requirement: Requirement) -> frozenset[str]:
    """Return the extras in whose marker a requirement stands; none for the base."""
    if requirement.marker is None:
        return frozenset()
    words = str(requirement.marker).replace("(", " ").replace(")", " ").split()
    return frozenset(
        words[at + 2].strip("\"'") for at, word in enumerate(words[:-2]) if word == "extra" and words[at + 1] == "=="
    )
