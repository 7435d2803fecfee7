"""Coverage as one self-contained HTML page: totals, missing items, and the annotated documents."""

from __future__ import annotations

from html import escape
from pathlib import Path

from engine.coverage.coverage_file import BehaviorCoverage, percent, text_hash
from engine.coverage.coverage_item import CoverageItem
from engine.coverage.line_coverage import CoverageLine, FileCoverage, LineStatus, by_file

_STYLE = Path(__file__).with_name("report.css")
_MARKS: dict[LineStatus, str] = {"covered": "✓", "partial": "◐", "missed": "✗"}
_WORDS: dict[LineStatus, str] = {"covered": "covered", "partial": "partly covered", "missed": "not covered"}


def html_page(coverages: tuple[BehaviorCoverage, ...]) -> str:
    """Return the page; a document is shown line by line if its file is unchanged since the run."""
    files = by_file(coverages)
    share = percent(sum(c.covered for c in coverages), sum(len(c.items) for c in coverages))
    names = ", ".join(coverage.behavior for coverage in coverages)
    anchors = {file.file: f"f{number}" for number, file in enumerate(files)}
    sections = [
        f"<h1>Coverage of {escape(names)}</h1>",
        f'<p class="quiet">{share:.1f} % of nodes and of their exits are covered.</p>',
        _files(files, anchors),
        *(_missing(coverage, anchors) for coverage in coverages),
        *(_source(file, anchors[file.file]) for file in files),
    ]
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{share:.0f} % – coverage of {escape(names)}</title>\n"
        f"<style>\n{_STYLE.read_text(encoding='utf-8')}</style>\n</head>\n<body>\n<main>\n"
        + "\n".join(sections)
        + "\n</main>\n</body>\n</html>\n"
    )


def _files(files: tuple[FileCoverage, ...], anchors: dict[str, str]) -> str:
    rows = [
        f'<tr><th scope="row"><a href="#{anchors[file.file]}">{escape(file.file)}</a></th>'
        f"<td>{_meter(file.percent, file.file)}</td>"
        f'<td class="number">{sum(len(line.nodes) for line in file.lines)}</td>'
        f'<td class="number">{file.branches_taken} of {file.branches}</td></tr>'
        for file in files
    ]
    head = (
        '<th scope="col">Document</th><th scope="col">Covered</th>'
        '<th scope="col" class="number">Nodes</th><th scope="col" class="number">Exits taken</th>'
    )
    return _table("Documents", head, rows)


def _meter(share: float, of: str) -> str:
    label = escape(f"Covered share of {of}", quote=True)
    return (
        f'<meter min="0" max="100" low="60" high="85" optimum="100" value="{share:.1f}" aria-label="{label}"></meter> '
        f"{share:.1f} %"
    )


def _missing(coverage: BehaviorCoverage, anchors: dict[str, str]) -> str:
    runs = "one run" if coverage.runs == 1 else f"{coverage.runs} runs"
    title = f"<h2>Missing in {escape(coverage.behavior)}</h2>"
    entered = {item.path for item in coverage.items if item.kind == "node" and item.count}
    missing: dict[str, list[CoverageItem]] = {}
    for item in coverage.items:
        if not item.count and (item.kind == "node" or item.path in entered):
            missing.setdefault(item.path, []).append(item)
    if not missing:
        return f"{title}\n<p>Nothing: everything is covered by {runs}.</p>"
    rows = [
        f'<tr><th scope="row"><code>{escape(path)}</code></th>'
        f"<td><ul>{''.join(_missed_item(item, anchors) for item in items)}</ul></td></tr>"
        for path, items in missing.items()
    ]
    return f"{title}\n" + _table(
        f"Not covered by {runs}", '<th scope="col">Node</th><th scope="col">Not covered</th>', rows
    )


def _missed_item(item: CoverageItem, anchors: dict[str, str]) -> str:
    link = f"#{anchors[item.file]}-{item.line}"
    return f'<li>{escape(item.label)}, <a href="{link}">line {item.line}</a></li>'


def _source(file: FileCoverage, anchor: str) -> str:
    title = f'<h2 id="{anchor}">{escape(file.file)}</h2>'
    path = Path(file.file)
    if not file.text or text_hash(path) != file.text:
        return f'{title}\n<p class="quiet">The file is missing or has changed since the run.</p>'
    lines = {line.number: line for line in file.lines}
    text = path.read_text(encoding="utf-8").splitlines()
    rows = [_row(number, code, lines.get(number), anchor) for number, code in enumerate(text, start=1)]
    head = (
        '<th scope="col" class="number">Line</th><th scope="col" class="number">Hits</th>'
        '<th scope="col"><span class="hidden">Status</span></th><th scope="col">Text</th>'
    )
    return f"{title}\n" + _table("The document, line by line", head, rows, kind="source")


def _row(number: int, code: str, line: CoverageLine | None, anchor: str) -> str:
    place = f'{anchor}-{number}"'
    numbered = f'<td class="number"><a href="#{place}>{number}</a></td>'
    if line is None:
        return f'<tr id="{place}>{numbered}<td></td><td></td><td class="code">{escape(code)}</td></tr>'
    note = "; ".join(item.label for item in line.missing)
    remark = f'<span class="note">not covered: {escape(note)}</span>' if note else ""
    mark = f'<span aria-hidden="true">{_MARKS[line.status]}</span><span class="hidden">{_WORDS[line.status]}</span>'
    return (
        f'<tr id="{place} class="{line.status}">{numbered}<td class="number">{line.hits}</td>'
        f'<td class="mark">{mark}</td><td class="code">{escape(code)}{remark}</td></tr>'
    )


def _table(caption: str, head: str, rows: list[str], *, kind: str = "") -> str:
    # A scrollable region must be reachable by keyboard, and have a label.
    label = escape(caption, quote=True)
    return (
        f'<div class="scroll" role="region" aria-label="{label}" tabindex="0">\n'
        f'<table class="{kind}"><caption>{escape(caption)}</caption>\n'
        f"<thead><tr>{head}</tr></thead>\n<tbody>\n" + "\n".join(rows) + "\n</tbody></table></div>"
    )
