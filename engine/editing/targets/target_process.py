"""The target check process: computes arm postures at the targets of texts, separate from the server."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path

import msgspec

from engine.check import check_rest_of_items, check_targets
from engine.document.cell import cell_of_source
from engine.document.loader import survey_behavior
from engine.document.text.yaml_source import parse_source
from engine.editing.analysis.diagnostics import draw_document, finding_view, sorted_findings
from engine.editing.project_context import ProjectContext
from engine.editing.targets.target_messages import TargetFindings, TargetRequest
from engine.editing.text.draft import Draft
from engine.editing.text.outline import Outline
from engine.errors import DocumentError, FlexcellError
from engine.host.child_process import set_parent_death_signal
from engine.library.behavior_library import FindingView
from engine.library.state_reloading import StateReloading
from engine.registry import load_states
from engine.runtime.plan import Catalogue

_NICER_BY = 10
_Loaded = tuple[Catalogue, StateReloading]


def main() -> None:
    """Serve the socket whose descriptor is the first argument until the other end closes it."""
    connection = socket.socket(fileno=int(sys.argv[1]))
    set_parent_death_signal(connection)
    # Moving arms, and the response to the next edit, have priority.
    os.nice(_NICER_BY)
    catalogues: dict[str, _Loaded] = {}
    with connection.makefile("rb") as requests:
        for line in requests:
            request = msgspec.json.decode(line, type=TargetRequest)
            connection.sendall(msgspec.json.encode(_answered(request, catalogues)) + b"\n")


def _answered(request: TargetRequest, catalogues: dict[str, _Loaded]) -> TargetFindings:
    project = Path(request.project)
    try:
        if request.of == "cell":
            return rest_findings(request.text, Path(request.file))
        if request.project not in catalogues:
            catalogue = load_states(project)
            catalogues[request.project] = (catalogue, StateReloading(project, catalogue))
        catalogue, reloading = catalogues[request.project]
        reloading.load()
        return target_findings(request.text, Path(request.file), project, catalogue)
    except FlexcellError as error:
        return TargetFindings(problem=str(error))


def rest_findings(text: str, file: Path) -> TargetFindings:
    """Return what touches at rest in the text of a cell, as the content of `file`, at both items of each pair.

    A text with errors has none: the check reports these. The line of an item of a module is 0.
    """
    try:
        cell = cell_of_source(parse_source(text, file=str(file)), file=file)
    except (DocumentError, OSError):
        return TargetFindings()
    found = (
        FindingView(
            severity=each.severity,
            code=each.code,
            message=each.message,
            path=each.path,
            line=each.position.line if each.position.file == str(file) else 0,
            column=each.position.column if each.position.file == str(file) else 0,
            hint=each.hint,
        )
        for each in check_rest_of_items(cell)
    )
    return TargetFindings(findings=tuple(found))


def target_findings(text: str, file: Path, project: Path, catalogue: Catalogue) -> TargetFindings:
    """Return the targets in a text, as the content of `file`, that an arm of its own cell cannot take.

    For a text that cannot be read, or leads out of the project, the result is empty: the check reports that.
    """
    context = ProjectContext(catalogue, file.parent, project)
    try:
        draft = Draft(text, file=str(file))
    except DocumentError:
        return TargetFindings()
    drawn, graph = draw_document(draft, Outline(draft.data), file=file, context=context)
    behavior = survey_behavior(file, text, within=project).behavior if not drawn.findings else None
    if behavior is None:
        return TargetFindings()
    found = [finding_view(each, file) for each in check_targets(behavior, catalogue) if each.severity == "warning"]
    return TargetFindings(findings=sorted_findings(found, graph))
