"""Tables and pages that all reports of sweeps consist of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from pathlib import Path

_STYLE = Path(__file__).with_name("report.css")


def html_document(title: str, sections: Iterable[str]) -> str:
    """Return a page that loads nothing."""
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>\n{_STYLE.read_text(encoding='utf-8')}</style>\n"
        "</head>\n<body>\n<main>\n" + "\n".join(sections) + "\n</main>\n</body>\n</html>\n"
    )


def html_table(title: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[str]:
    """Yield a heading and a table; nothing without rows."""
    body = "".join(f"<tr>{''.join(f'<td>{escape(str(cell))}</td>' for cell in row)}</tr>" for row in rows)
    if body:
        names = "".join(f'<th scope="col">{escape(name)}</th>' for name in head)
        yield (
            f'<h2>{escape(title)}</h2><div class="scroll" tabindex="0"><table><thead><tr>{names}</tr></thead>'
            f"<tbody>{body}</tbody></table></div>"
        )


def markdown_section(title: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[str]:
    """Yield the lines of a heading and a table; none without rows."""
    found = [tuple(map(_cell, row)) for row in rows]
    if not found:
        return
    # Padded, so that the text reads well in a terminal too.
    widths = [max(len(row[column]) for row in (tuple(head), *found)) for column in range(len(head))]
    yield ""
    yield f"## {title}"
    yield ""
    yield _row(head, widths)
    yield _row(["-" * width for width in widths], widths)
    yield from (_row(row, widths) for row in found)


def _row(cells: Sequence[str], widths: Sequence[int]) -> str:
    return f"| {' | '.join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True))} |"


def _cell(value: object) -> str:
    return " ".join(str(value).replace("|", "\\|").split())
