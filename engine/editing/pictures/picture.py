"""Pictures of whole behaviors: drawn by the program of the page, in a JavaScript engine, without a browser."""

from __future__ import annotations

import json
import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal, cast

import msgspec

from engine.editing.analysis.document_graph import DocumentInfo, DocumentNode
from engine.editing.pictures.fonts import INSTALL_FONT, NO_FONT
from engine.editing.pictures.picture_package import picture_package
from engine.errors import FlexcellError

PROGRAM = "static/picture.js"
"""The file of the page that draws, relative to the package of the page."""
_MEMORY_BYTES = 2 << 30
_STACK_BYTES = 64 << 20
_LONGEST_PX = 16_000
_SCALE = 2.0
"""Pixels of a PNG for one of the drawing, as the page exports it."""
_FAMILY = re.compile(r'font-family:(&[#\w]+;|[^;"])+')
"""The fonts of a text, as an attribute has them: with quotes as entities."""
_DRAW = """
globalThis.made = null; globalThis.failed = null;
flexcell.pictureFile(%s).then((svg) => { made = svg }, (error) => { failed = String(error) })
"""


class PictureRequest(msgspec.Struct, frozen=True, kw_only=True):
    """What the program is asked for: which containers show their inside.

    Those that the canvas opens by itself, or with `depth` those of so many levels; with `all` every one. Those in
    `open` and around them are open in any case.
    """

    graph: DocumentNode
    document: DocumentInfo
    scheme: Literal["light", "dark"] = "light"
    all: bool = False
    depth: int | None = None
    open: tuple[str, ...] = ()


def draw_svg(request: PictureRequest) -> str:
    """Return the picture of a behavior as an SVG, the same that the page exports.

    Raises:
        FlexcellError: the JavaScript engine is not installed, the page is not built, or the drawing failed.
    """
    engine: Any = picture_package("quickjs", "the JavaScript engine that draws")
    context = engine.Context()
    context.set_memory_limit(_MEMORY_BYTES)
    context.set_max_stack_size(_STACK_BYTES)
    context.eval(f"{_program().read_text(encoding='utf-8')};globalThis.flexcell = flexcell")
    context.eval(_DRAW % msgspec.json.encode(request).decode())
    while context.execute_pending_job():
        pass
    # As JSON, since the engine does not give out texts that it has put together of many.
    made, failed = (
        cast("str | None", json.loads(context.eval(f"JSON.stringify({name})"))) for name in ("made", "failed")
    )
    if made is None:
        raise FlexcellError(f"the behavior could not be drawn: {failed or 'the drawing has not ended'}")
    return made


def png_of(svg: str) -> bytes:
    """Return an SVG of `draw_svg` as a PNG, twice as large, or as large as 16,000 pixels allow.

    Raises:
        FlexcellError: what draws pixels is not installed, or there is no font on this machine.
    """
    drawing: Any = picture_package("resvg_py", "what draws pixels")
    if not _has_fonts(drawing, svg):
        raise FlexcellError(NO_FONT, hint=INSTALL_FONT)
    longest = max(float(each) for each in _size(svg))
    return bytes(drawing.svg_to_bytes(svg_string=svg, zoom=min(_SCALE, _LONGEST_PX / longest)))


def _has_fonts(drawing: Any, svg: str) -> bool:
    """Return whether a letter in the font of the names leaves a trace."""
    family = _FAMILY.search(svg)
    if family is None:
        return True
    letter = '<svg xmlns="http://www.w3.org/2000/svg" width="20" height="20">{}</svg>'
    text = f'<text x="2" y="16" style="{family.group()}">M</text>'
    blank, written = (bytes(drawing.svg_to_bytes(svg_string=letter.format(each))) for each in ("", text))
    return blank != written


def _size(svg: str) -> tuple[str, str]:
    width, height = (re.search(rf'<svg[^>]* {name}="([^"]+)"', svg) for name in ("width", "height"))
    return (width.group(1), height.group(1)) if width is not None and height is not None else ("1", "1")


def _program() -> Path:
    spec = find_spec("editor_web")
    file = Path(spec.origin).parent / PROGRAM if spec is not None and spec.origin else Path(PROGRAM)
    if not file.is_file():
        raise FlexcellError(f"the page is not built: {file} is missing", hint="build it: `pip install -e .`")
    return file
