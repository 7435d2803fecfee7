"""A picture as PDF: the SVG of a behavior on one page of its size, with its texts as texts."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from io import BytesIO
from math import isfinite
from typing import Any

from engine.editing.pictures.fonts import FontChoice, font_folders
from engine.editing.pictures.picture_package import picture_package
from engine.errors import FlexcellError

_PX_PT = 0.75
"""A pixel of an SVG is the 96th part of an inch, a point the 72nd."""
_LONGEST_PT = 14_400.0
"""Larger pages are not displayed by all programs."""
_SVG = "{http://www.w3.org/2000/svg}"
_INHERITED = ("fill", "font-family", "font-size", "font-weight", "text-anchor")
_NUMBER = re.compile(r"-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?")
_COUNTS = {"M": 2, "L": 2, "Q": 4, "C": 6, "Z": 0}
_DEEPEST = 40
"""Pictures of behaviors have groups in groups, but not more."""
_SHARES = {"middle": 0.5, "end": 1.0}

Style = Mapping[str, str]


def pdf_of(svg: str) -> bytes:
    """Return an SVG of `draw_svg`, or one that the page exports, as a PDF; the same bytes for the same SVG.

    Raises:
        FlexcellError: what writes PDF is not installed, there is no font on this machine, or this is another SVG.
    """
    library = picture_package("reportlab.pdfgen.canvas", "what writes PDF")
    root = _parsed(svg)
    left, top, width, height = _numbers(root.get("viewBox", ""), 4)
    if min(width, height) <= 0:
        raise FlexcellError("this SVG has no size")
    scale = min(_PX_PT, _LONGEST_PT / max(width, height))
    made = BytesIO()
    page = library.Canvas(made, pagesize=(width * scale, height * scale), invariant=1, pageCompression=1)
    page.setTitle(root.findtext(f"{_SVG}title", ""))
    page.setCreator("flexcell")
    page.setAuthor("")
    page.setSubject("")
    # From here on as in the SVG: in its pixels, and down the page.
    page.transform(scale, 0, 0, -scale, -left * scale, (top + height) * scale)
    _Drawing(page, FontChoice(font_folders())).draw(root, {})
    page.showPage()
    page.save()
    return made.getvalue()


def _parsed(svg: str) -> ET.Element:
    if "<!" in svg:
        raise FlexcellError("an SVG with declarations or comments is none of a behavior")
    try:
        root = ET.fromstring(svg)  # noqa: S314  # it declares no entities
    except ET.ParseError as error:
        raise FlexcellError(f"this is no SVG: {error}") from error
    if root.tag != f"{_SVG}svg":
        raise FlexcellError("this is no SVG")
    return root


def _numbers(text: str, count: int) -> list[float]:
    found = [float(each) for each in _NUMBER.findall(text)]
    if len(found) != count or not all(map(isfinite, found)):
        raise FlexcellError(f"this SVG has {text[:40]!r} where numbers belong: {count}")
    return found


@dataclass(frozen=True)
class _Drawing:
    """Draws the elements that pictures of behaviors consist of onto a page."""

    page: Any
    fonts: FontChoice

    def draw(self, element: ET.Element, inherited: Style, depth: int = 0) -> None:
        """Draw an element and all in it.

        Raises:
            FlexcellError: there is something in it that pictures of behaviors do not have.
        """
        if depth > _DEEPEST:
            raise FlexcellError("this SVG is nested too deeply")
        style = {**{key: inherited[key] for key in _INHERITED if key in inherited}, **_style_of(element)}
        at = _Attributes(element)
        match element.tag.removeprefix(_SVG):
            case "svg" | "g":
                for child in element:
                    self.draw(child, style, depth + 1)
            case "title":
                pass
            case "text":
                self._text(element, style)
            case "rect":
                x, y, width, height = (at[name] for name in ("x", "y", "width", "height"))
                radius = min(at["rx"], width / 2, height / 2)
                self._shape(style, lambda how: self.page.roundRect(x, y, width, height, radius, **how))
            case "circle":
                self._shape(style, lambda how: self.page.circle(at["cx"], at["cy"], at["r"], **how))
            case "line":
                ends = [at[name] for name in ("x1", "y1", "x2", "y2")]
                self._shape({**style, "fill": "none"}, lambda _: self.page.line(*ends))
            case "path":
                path = self._path(element.get("d", ""))
                self._shape(style, lambda how: self.page.drawPath(path, **how))
            case other:
                raise FlexcellError(f"an SVG with <{other}> is none of a behavior")

    def _shape(self, style: Style, draw: Callable[[dict[str, int]], Any]) -> None:
        """Draw with fill and stroke as the style says."""
        self.page.saveState()
        fill, stroke = _colour(style.get("fill", "#000000")), _colour(style.get("stroke", "none"))
        if fill is not None:
            self.page.setFillColorRGB(*fill[:3], alpha=fill[3] * _share(style, "fill-opacity"))
        if stroke is not None:
            self.page.setStrokeColorRGB(*stroke[:3], alpha=stroke[3] * _share(style, "stroke-opacity"))
            self.page.setLineWidth(_first(style.get("stroke-width", "1")))
            dashes = [float(each) for each in _NUMBER.findall(style.get("stroke-dasharray", ""))]
            if dashes:
                self.page.setDash(dashes)
        draw({"fill": int(fill is not None), "stroke": int(stroke is not None)})
        self.page.restoreState()

    def _path(self, text: str) -> Any:
        path = self.page.beginPath()
        x = y = 0.0
        for name, numbers in _steps(text):
            match name, numbers:
                case "M", (x, y):
                    path.moveTo(x, y)
                case "L", (x, y):
                    path.lineTo(x, y)
                case "Q", (a, b, to_x, to_y):
                    # A curve of the second degree as one of the third.
                    first = (x + 2 * (a - x) / 3, y + 2 * (b - y) / 3)
                    x, y = to_x, to_y
                    path.curveTo(*first, x + 2 * (a - x) / 3, y + 2 * (b - y) / 3, x, y)
                case "C", (*bends, x, y):
                    path.curveTo(*bends, x, y)
                case _:
                    path.close()
        return path

    def _text(self, element: ET.Element, style: Style) -> None:
        """Write a text and its parts, one behind the other unless a part stands at a place of its own."""
        at = _Attributes(element)
        x, y = at["x"], at["y"]
        runs = [self._run(element.text, style)]
        for part in element:
            place = _Attributes(part)
            own = self._run(part.text, {**style, **_style_of(part)})
            runs.append(_Run(own.pieces, own.style, x=place["x"] if "x" in part.attrib else None, dx=place["dx"]))
            runs.append(self._run(part.tail, style))
        x -= _SHARES.get(style.get("text-anchor", ""), 0.0) * sum(self._width(run) + run.dx for run in runs)
        for run in runs:
            x = (x if run.x is None else run.x) + run.dx
            for words, font in run.pieces:
                self._write(words, font, run.style, x, y)
                x += self.page.stringWidth(words, font, run.size)

    def _run(self, text: str | None, style: Style) -> _Run:
        families = [each.strip(" '\"") for each in style.get("font-family", "").split(",")]
        weight = _first(style.get("font-weight", "400"))
        words = re.sub(r"\s", " ", text or "")
        return _Run(self.fonts.pieces(words, families, weight), style)

    def _width(self, run: _Run) -> float:
        return sum(self.page.stringWidth(words, font, run.size) for words, font in run.pieces)

    def _write(self, words: str, font: str, style: Style, x: float, y: float) -> None:
        red, green, blue, alpha = _colour(style.get("fill", "#000000")) or (0.0, 0.0, 0.0, 0.0)
        self.page.saveState()
        self.page.translate(x, y)
        # Letters stand upright.
        self.page.scale(1, -1)
        self.page.setFillColorRGB(red, green, blue, alpha=alpha)
        self.page.setFont(font, _first(style.get("font-size", "16")))
        self.page.drawString(0, 0, words)
        self.page.restoreState()


@dataclass(frozen=True)
class _Run:
    """A piece of a text in one style; at `x` where that is given, else `dx` behind the one before."""

    pieces: list[tuple[str, str]]
    style: Style
    x: float | None = None
    dx: float = 0.0

    @property
    def size(self) -> float:
        return _first(self.style.get("font-size", "16"))


@dataclass(frozen=True)
class _Attributes:
    """The numbers among the attributes of an element; 0 where there is none."""

    element: ET.Element

    def __getitem__(self, name: str) -> float:
        return _first(self.element.get(name, "0"))


def _style_of(element: ET.Element) -> dict[str, str]:
    pairs = (each.partition(":") for each in element.get("style", "").split(";"))
    return {name.strip(): value.strip() for name, colon, value in pairs if colon}


def _first(text: str) -> float:
    return _numbers(text.partition("px")[0], 1)[0]


def _share(style: Style, name: str) -> float:
    return _first(style.get(name, "1"))


def _colour(text: str) -> tuple[float, float, float, float] | None:
    """Return red, green, blue and opacity, each from 0 to 1; None for no colour."""
    if text == "none":
        return None
    if re.fullmatch(r"#[0-9a-fA-F]{6}", text):
        red, green, blue = (int(text[at : at + 2], 16) / 255 for at in (1, 3, 5))
        return red, green, blue, 1.0
    if re.fullmatch(r"rgba?\([^()]*\)", text):
        red, green, blue, alpha = _numbers(f"{text[:-1]}, 1" if text.startswith("rgb(") else text, 4)
        return red / 255, green / 255, blue / 255, alpha
    raise FlexcellError(f"the colour {text!r} of this SVG is not known")


def _steps(path: str) -> Iterator[tuple[str, list[float]]]:
    """Yield the commands of a path with their numbers.

    Raises:
        FlexcellError: a command that pictures of behaviors do not have.
    """
    for command in re.findall(r"[A-DF-Za-df-z][^A-DF-Za-df-z]*", path):
        name, numbers = command[0], [float(each) for each in _NUMBER.findall(command)]
        count = _COUNTS.get(name.upper() if name == "z" else name)
        if count is None or not all(map(isfinite, numbers)) or (len(numbers) % count if count else numbers):
            raise FlexcellError(f"the path {path[:40]!r} of this SVG is not known")
        # Further numbers are those of a further command of the same name.
        for at in range(0, len(numbers), count) if count else (0,):
            yield name.upper(), numbers[at : at + count]
