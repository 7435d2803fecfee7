"""Locates installed robot descriptions: packages, `package://` URIs, and the SRDF's collision pairs."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from engine.errors import CellError
from robots.model.urdf.untrusted_xml import parse_xml, read_text

PACKAGE_SCHEME = "package://"


def installed_share_dir(*, package: str, marker: str) -> Path:
    """Return the folder of an installed distribution that contains `marker` (a relative path).

    Raises:
        CellError: the distribution is not installed, or installed without that file.
    """
    advice = f"pip install {package}"
    try:
        installed = distribution(package)
    except PackageNotFoundError as error:
        raise CellError(f"the Python package {package} is not installed", where=package, hint=advice) from error
    suffix = "/" + marker
    for file in _files(installed, marker):
        if f"/{file}".endswith(suffix):
            path = Path(str(installed.locate_file(file)))
            if path.is_file():
                return Path(str(path.resolve()).removesuffix(suffix))
    raise CellError(f"the package {package} has no file {marker}", where=package, hint=f"{advice} --force-reinstall")


def _files(installed: Distribution, marker: str) -> Iterable[str]:
    """Return the files of a distribution whose paths contain `marker`."""
    record = installed.read_text("RECORD")
    if record is None:
        return map(str, installed.files or ())
    # `files` would create an object for each of thousands of lines, several times per arm.
    lines = (line for line in record.splitlines() if marker in line)
    return (row[0] for row in csv.reader(lines))


def resolve_uri(uri: str, *, package_dirs: Sequence[Path], relative_to: Path) -> Path:
    """Return the file of a URDF's mesh `filename`.

    `package://<path>` is below one of `package_dirs`; anything else is relative to the folder `relative_to`.

    Raises:
        CellError: there is no such file.
    """
    if uri.startswith(PACKAGE_SCHEME):
        paths = [folder / uri.removeprefix(PACKAGE_SCHEME) for folder in package_dirs]
    else:
        paths = [relative_to / uri.removeprefix("file://")]
    if "\0" in uri:
        raise CellError("the name of a mesh file contains a NUL character", where=uri, hint="correct the URDF")
    for path in paths:
        if path.is_file():
            return path
    missing = " or ".join(str(path) for path in paths)
    raise CellError(f"no mesh file {missing}", where=uri, hint="check the package folder of the robot model")


def disabled_collisions(srdf: Path) -> tuple[tuple[str, str], ...]:
    """Return the link pairs of an SRDF's `disable_collisions`, in file order.

    Raises:
        CellError: it cannot be read.
    """
    root = parse_xml(read_text(srdf, what="SRDF"), what="SRDF", where=srdf)
    pairs = tuple((pair.get("link1", ""), pair.get("link2", "")) for pair in root.iter("disable_collisions"))
    if not all(map(all, pairs)):
        raise CellError("a `disable_collisions` has no `link1` or no `link2`", where=str(srdf), hint="correct the SRDF")
    return pairs
