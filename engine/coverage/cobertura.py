"""Coverage as Cobertura XML for CI servers: nodes are lines, exits of nodes are branches."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from engine.coverage.coverage_file import BehaviorCoverage, percent
from engine.coverage.line_coverage import CoverageLine, FileCoverage, by_file

_DOCTYPE = '<!DOCTYPE coverage SYSTEM "http://cobertura.sourceforge.net/xml/coverage-04.dtd">'


def cobertura_report(coverages: tuple[BehaviorCoverage, ...], *, version: str, time_s: float) -> str:
    """Return the report; `version` is the version of the program, `time_s` the report time in Unix time."""
    files = by_file(coverages)
    covered, valid = sum(file.lines_covered for file in files), sum(len(file.lines) for file in files)
    taken, branches = sum(file.branches_taken for file in files), sum(file.branches for file in files)
    root = Element(
        "coverage",
        {
            "line-rate": _rate(covered, valid),
            "branch-rate": _rate(taken, branches),
            "lines-covered": str(covered),
            "lines-valid": str(valid),
            "branches-covered": str(taken),
            "branches-valid": str(branches),
            "complexity": "0",
            "version": version,
            "timestamp": str(int(time_s * 1000)),
        },
    )
    SubElement(SubElement(root, "sources"), "source").text = Path.cwd().as_posix()
    packages = SubElement(root, "packages")
    for folder in sorted({_folder(file) for file in files}):
        _package(packages, folder, [file for file in files if _folder(file) == folder])
    indent(root)
    return f'<?xml version="1.0" ?>\n{_DOCTYPE}\n{tostring(root, encoding="unicode")}\n'


def _package(packages: Element, folder: str, files: list[FileCoverage]) -> None:
    package = SubElement(
        packages,
        "package",
        {
            "name": folder.replace("/", "."),
            "line-rate": _rate(sum(f.lines_covered for f in files), sum(len(f.lines) for f in files)),
            "branch-rate": _rate(sum(f.branches_taken for f in files), sum(f.branches for f in files)),
            "complexity": "0",
        },
    )
    classes = SubElement(package, "classes")
    for file in files:
        element = SubElement(
            classes,
            "class",
            {
                "name": Path(file.file).name,
                "filename": file.file,
                "line-rate": _rate(file.lines_covered, len(file.lines)),
                "branch-rate": _rate(file.branches_taken, file.branches),
                "complexity": "0",
            },
        )
        SubElement(element, "methods")
        lines = SubElement(element, "lines")
        for line in file.lines:
            _line(lines, line)


def _line(lines: Element, line: CoverageLine) -> None:
    attributes = {"number": str(line.number), "hits": str(line.hits), "branch": "false"}
    if line.branches:
        share = f"{percent(line.taken, len(line.branches)):.0f}%"
        attributes |= {"branch": "true", "condition-coverage": f"{share} ({line.taken}/{len(line.branches)})"}
    element = SubElement(lines, "line", attributes)
    if line.branches:
        conditions = SubElement(element, "conditions")
        for number, branch in enumerate(line.branches):
            coverage = "100%" if branch.item.count else "0%"
            SubElement(conditions, "condition", {"number": str(number), "type": "jump", "coverage": coverage})


def _folder(file: FileCoverage) -> str:
    return Path(file.file).parent.as_posix()


def _rate(covered: int, total: int) -> str:
    return f"{percent(covered, total) / 100:.4g}"
