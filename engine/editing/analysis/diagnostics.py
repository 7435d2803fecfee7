"""Diagnostics of a text under edit: its graph and its findings."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from engine.check import Finding, check_survey
from engine.document.loader import survey_behavior
from engine.editing.analysis.document_graph import DocumentInfo, DocumentNode, DrawnGraph, draw_graph, info_of
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft
from engine.editing.text.draft_source import keep_nodes, syntax_source
from engine.editing.text.outline import Outline, Plain
from engine.errors import DocumentError, Position
from engine.library.behavior_library import FindingView


@dataclass(frozen=True, kw_only=True)
class DocumentAnalysis:
    """Graph and findings of a text; `graph` and `document` are None if it cannot be read.

    `checked` is False if the graph was built but the check has not run yet.
    """

    hash: str
    graph: DocumentNode | None
    document: DocumentInfo | None
    findings: tuple[FindingView, ...]
    checked: bool


def text_hash(text: str) -> str:
    """Return the SHA-256 of a text as encoded in a file."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def analyze_text(text: str, *, file: Path, context: ProjectContext) -> DocumentAnalysis:
    """Build the graph and the findings of a text, as if it were the content of `file`."""
    try:
        draft = Draft(text, file=str(file))
    except DocumentError as error:
        return analyze_unreadable_text(text, error, file=file, context=context)
    drawn, graph = draw_document(draft, Outline(draft.data), file=file, context=context)
    return replace(with_findings(drawn, graph, text, file=file, context=context), graph=graph.whole())


def analyze_unreadable_text(
    text: str, error: DocumentError, *, file: Path, context: ProjectContext
) -> DocumentAnalysis:
    """Return the findings of a text without graph: at least this error."""
    found = findings_of(text, file=file, context=context)
    shown = found if any(each.severity == "error" for each in found) else (_invalid(error), *found)
    return DocumentAnalysis(hash=text_hash(text), graph=None, document=None, findings=shown, checked=True)


def draw_document(
    draft: Draft, outline: Outline, *, file: Path, context: ProjectContext, before: DrawnGraph | None = None
) -> tuple[DocumentAnalysis, DrawnGraph]:
    """Build the graph of a text, as if it were the content of `file`; one that leaves the project is not checked.

    The analysis is without the graph: who needs it as one value takes it `whole`.

    Args:
        draft: The text as it was read.
        outline: Its nodes.
        file: Its file.
        context: The states and behaviors around it.
        before: The graph of the text from which the draft was made.
    """
    graph = draw_graph(draft, context, outline, before)
    out = sorted_findings(find_external_references(draft, context, file, outline), graph)
    drawn = DocumentAnalysis(
        hash=text_hash(draft.given), graph=None, document=info_of(draft), findings=out, checked=bool(out)
    )
    return drawn, graph


def with_findings(
    drawn: DocumentAnalysis,
    graph: DrawnGraph,
    text: str,
    *,
    file: Path,
    context: ProjectContext,
    read: tuple[Draft, Outline] | None = None,
) -> DocumentAnalysis:
    """Return the diagnostics of a text whose graph exists, with its findings; `read` is the text as it was read."""
    if drawn.checked:
        return drawn
    found = _check(text, file, context, read)
    return replace(drawn, findings=sorted_findings(found, graph), checked=True)


def sorted_findings(found: list[FindingView], graph: DrawnGraph) -> tuple[FindingView, ...]:
    """Return findings in the order of the text, each with its line and node where one follows from the other."""
    return tuple(sorted((_placed(each, graph) for each in found), key=lambda each: (each.line, each.column)))


def findings_of(text: str, *, file: Path, context: ProjectContext) -> tuple[FindingView, ...]:
    """Return the findings of a text as if it were the content of `file`, in text order, without a graph."""
    found = _check(text, file, context)
    return tuple(sorted(found, key=lambda each: (each.line, each.column)))


def _check(
    text: str, file: Path, context: ProjectContext, read: tuple[Draft, Outline] | None = None
) -> list[FindingView]:
    source = syntax_source(read[0]) if read is not None else None
    survey = survey_behavior(file, text, source=source, within=context.project)
    if read is not None and survey.behavior is not None and survey.behavior.source is source:
        keep_nodes(survey.behavior, *read)
    cell = survey.behavior.cell_file if survey.behavior is not None else None
    entries = context.stored(cell) if cell is not None else None
    return [finding_view(finding, file) for finding in check_survey(survey, file, context.catalogue, entries)]


def find_external_references(
    draft: Draft, context: ProjectContext, file: Path, outline: Outline | None = None
) -> list[FindingView]:
    """Return the references of a text to files outside the project, which must not be read; `outline` are its nodes."""
    refs = (outline or Outline(draft.data)).refs
    named: list[tuple[str, Plain, str]] = [
        (path, ref.data, "behavior") for path, ref in refs.items() if "behavior" in ref.data
    ]
    named += [("", draft.data, "cell")] if isinstance(draft.data.get("cell"), str) else []
    found: list[FindingView] = []
    for path, data, key in named:
        written = data[key]
        if isinstance(written, str) and not _is_inside(file.parent, written, context.project):
            source = draft.source_of(data)
            member = (
                next((m for m in source.members if m.key is not None and m.key.value == key), None) if source else None
            )
            at = member.value.start if member is not None else 0
            before = draft.origin.text[:at]
            found.append(
                FindingView(
                    severity="error",
                    code="invalid-document",
                    message=f"`{written}` leads out of the project",
                    path=path,
                    line=before.count("\n") + 1,
                    column=at - before.rfind("\n"),
                    hint="name a file of this project, relative to this document",
                )
            )
    return found


def _is_inside(folder: Path, written: str, project: Path) -> bool:
    try:
        return (folder / written).resolve().is_relative_to(project.resolve())
    except (OSError, ValueError):
        return False


def _invalid(error: DocumentError) -> FindingView:
    here = error.where if isinstance(error.where, Position) else Position(file="", line=1, column=1)
    return FindingView(
        severity="error", code="invalid-document", message=error.message, path="",
        line=here.line, column=here.column, hint=error.hint or "",
    )  # fmt: skip


def finding_view(finding: Finding, file: Path) -> FindingView:
    """Return a finding as shown in `file`; one of another behavior appears at the node that references it."""
    position, message, path = finding.position, finding.message, finding.path
    if position.file != str(file):
        # A finding in a referenced behavior: the node that references it is what can be shown here.
        path = path.partition("/root")[0] or "root"
        message = f"{Path(position.file).name}:{position.line}: {message}"
        line = 0 if finding.path else 1
        path, position = path if finding.path else "", Position(file=str(file), line=line, column=line)
    return FindingView(
        severity=finding.severity, code=finding.code, message=message, path=path,
        line=position.line, column=position.column, hint=finding.hint or "",
    )  # fmt: skip


def _placed(finding: FindingView, graph: DrawnGraph) -> FindingView:
    """Complete a finding that has only a node or only a line with the other one."""
    if finding.line == 0:
        node = graph.nodes.get(finding.path)
        line, column = node.lines[:2] if node is not None else (1, 1)
        return msgspec.structs.replace(finding, line=line, column=column)
    if finding.path:
        return finding
    around = [path for path, node in graph.nodes.items() if node.lines[0] <= finding.line <= node.lines[2]]
    # The innermost one; the last where several are on this line.
    path = max(reversed(around), key=lambda each: each.count("/"), default="")
    return msgspec.structs.replace(finding, path=path)
