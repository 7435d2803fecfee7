"""Writes fixes into behavior documents, for `flexcell check --fix`."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from engine.check.analyzed_behavior import Catalogue
from engine.document.python_name import is_python_name
from engine.document.text.yaml_source import MAX_BYTES, load_source
from engine.editing.fixes.auto_fix import FixResult, fix_text
from engine.editing.project_context import ProjectContext
from engine.editing.versions import write_atomically
from engine.errors import DocumentError, FlexcellError
from engine.library.behavior_library import FindingView


def fix_file(file: Path, catalogue: Catalogue, *, likely: bool) -> FixResult | None:
    """Apply to a behavior document the fixes that need no choice; None for an unreadable or other document.

    Raises:
        FlexcellError: the file cannot be written, or was changed during the fix; it is unchanged.
    """
    if is_python_name(str(file)) or not _is_behavior(file):
        return None
    content = _content(file)
    context = ProjectContext(catalogue, file.parent, Path(file.absolute().anchor))
    try:
        result = fix_text(content.decode("utf-8"), file=file, context=context, likely=likely)
    except UnicodeDecodeError:
        return None  # the check reports it
    if result.fixed:
        _write(file, content, result.text)
    return result


def fix_lines(file: Path, result: FixResult) -> Iterator[str]:
    """Return a line per fix applied, with the position at that time, and per finding that needs a choice."""
    for finding, fix in result.fixed:
        yield f"{_position(file, finding)}: fixed: {finding.message}: {fix.title} [{finding.code}]"
    for finding, fixes in result.left:
        if fixes:
            titles = "; or: ".join(fix.title for fix in fixes)
            yield f"{_position(file, finding)}: not fixed, choose one: {titles} [{finding.code}]"


def _position(file: Path, finding: FindingView) -> str:
    return f"{file}:{finding.line}:{finding.column}"


def _is_behavior(file: Path) -> bool:
    try:
        data = load_source(file).data
    except DocumentError:
        return False
    return isinstance(data, dict) and ("root" in data or "outcomes" in data)


def _content(file: Path) -> bytes:
    try:
        with file.open("rb") as stream:
            return stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise FlexcellError(f"cannot read this file: {error.strerror}", where=file) from error


def _write(file: Path, before: bytes, text: str) -> None:
    target = file.resolve()
    hint = "no fix was written; make the file writable, or check without `--fix`"
    if not target.stat().st_mode & 0o222 or not os.access(target, os.W_OK):
        raise FlexcellError("the file is read-only", where=file, hint=hint)
    if _content(target) != before:
        raise FlexcellError("the file was changed during the check", where=file, hint="no fix was written; check again")
    try:
        write_atomically(target, text)
    except OSError as error:
        raise FlexcellError(f"the file cannot be written: {error.strerror}", where=file, hint=hint) from error
