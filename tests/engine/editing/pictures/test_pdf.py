"""A picture as PDF: one page of its size, shapes in their colours and places, texts that can be read and searched."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from engine.editing.pictures import pdf_of
from engine.editing.pictures.fonts import NO_FONT, FontChoice, font_folders
from engine.errors import FlexcellError

FAMILY = "'Inter Variable', Inter, Arial, 'Liberation Sans', 'Noto Sans', 'DejaVu Sans', sans-serif"
HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<svg xmlns="http://www.w3.org/2000/svg" viewBox="-10 -20 400 200">'
SHAPES = f"""{HEAD}<title>shift &lt;1&gt;</title>
<rect x="-10" y="-20" width="400" height="200" style="fill:#ffffff"></rect>
<rect x="0" y="0" width="100" height="40" rx="10" style="fill:#ff0000;stroke:rgb(0, 0, 255);stroke-width:4px"></rect>
<rect x="110" y="0" width="40" height="40" style="fill:rgba(0, 0, 0, 0.5)"></rect>
<circle cx="200" cy="20" r="20" style="fill:#00ff00"></circle>
<line x1="0" x2="100" y1="80" y2="80" style="stroke:#ff00ff;stroke-width:6"></line>
<path d="M 150 60L 190 60Q 200,60 200,70L 200 100 L 150 100 z" style="fill:#00ffff"></path>
<path d="M 230 60 L 290 60" style="fill:none;stroke:#000000;stroke-width:8;stroke-dasharray:20px, 20px"></path>
<g style="font-family:{FAMILY}">
<text x="10" y="140" style="font-size:14px;font-weight:620;fill:#000000"
>grasp<tspan dx="8" style="font-size:11px;font-weight:400">Держать → ×2</tspan></text>
<text x="380" y="140" style="font-size:14px;text-anchor:end;fill:#000000">held</text>
<text x="10" y="160" style="font-size:12px;fill:#000000"><tspan>both</tspan><tspan x="200">left =\ta</tspan></text>
</g>
</svg>
"""


def opened(svg: str) -> Any:
    """The only page of the PDF."""
    pdfium: Any = pytest.importorskip("pypdfium2", reason="what reads PDF is not installed")
    pytest.importorskip("reportlab", reason="what writes PDF is not installed")
    document = pdfium.PdfDocument(pdf_of(svg))
    assert len(document) == 1
    return document[0]


def pixel(page: Any, x: float, y: float) -> tuple[int, ...]:
    """The colour at a place of the SVG, whose pixels are the pixels of the picture."""
    picture = page.render(scale=96 / 72).to_pil().convert("RGB")
    return picture.getpixel((round(x + 10), round(y + 20)))


def boxes_px(page: Any, words: str) -> tuple[float, float, float, float]:
    """Where a text is, as left, top, right and bottom in the SVG."""
    text = page.get_textpage()
    start, count = text.search(words).get_next()
    boxes = [text.get_charbox(at) for at in range(start, start + count)]
    left, bottom = min(box[0] for box in boxes), min(box[1] for box in boxes)
    right, top = max(box[2] for box in boxes), max(box[3] for box in boxes)
    return left / 0.75 - 10, 200 - top / 0.75 - 20, right / 0.75 - 10, 200 - bottom / 0.75 - 20


def test_the_page_is_as_large_as_the_picture_and_has_its_title() -> None:
    page = opened(SHAPES)
    assert page.get_size() == pytest.approx((300.0, 150.0))
    assert page.pdf.get_metadata_value("Title") == "shift <1>"
    assert pdf_of(SHAPES) == pdf_of(SHAPES)


def test_a_very_large_picture_is_made_as_large_as_programs_show() -> None:
    page = opened(SHAPES.replace('viewBox="-10 -20 400 200"', 'viewBox="0 0 40000 20000"'))
    assert page.get_size() == pytest.approx((14400.0, 7200.0))


@pytest.mark.parametrize(
    ("at", "colour"),
    [
        ((50, 20), (255, 0, 0)),
        ((50, 0), (0, 0, 255)),
        # Round corners.
        ((-1, -1), (255, 255, 255)),
        ((130, 20), (127, 127, 127)),
        ((200, 20), (0, 255, 0)),
        ((182, 2), (255, 255, 255)),
        ((50, 80), (255, 0, 255)),
        ((175, 80), (0, 255, 255)),
        ((240, 60), (0, 0, 0)),
        ((260, 60), (255, 255, 255)),
        ((280, 60), (0, 0, 0)),
    ],
)
def test_shapes_have_their_colours_where_they_stand(at: tuple[int, int], colour: tuple[int, int, int]) -> None:
    assert pixel(opened(SHAPES), *at) == pytest.approx(colour, abs=2)


def test_texts_are_texts_where_they_stand() -> None:
    page = opened(SHAPES)
    assert page.get_textpage().get_text_bounded().split() == [
        "grasp",
        "Держать",
        "→",
        "×2",
        "held",
        "both",
        "left",
        "=",
        "a",
    ]
    left, top, right, bottom = boxes_px(page, "grasp")
    assert (left, bottom) == pytest.approx((10, 140), abs=5)
    assert 128 < top < 134
    behind = boxes_px(page, "Держать")
    assert behind[0] == pytest.approx(right + 8, abs=3)
    assert boxes_px(page, "held")[2] == pytest.approx(380, abs=2)
    assert boxes_px(page, "left = a")[0] == pytest.approx(200, abs=2)


@pytest.mark.parametrize(
    ("svg", "problem"),
    [
        ("<svg", "this is no SVG"),
        ("<html></html>", "this is no SVG"),
        ('<!DOCTYPE svg [<!ENTITY a "b">]>' + SHAPES.partition("\n")[2], "declarations"),
        (HEAD + '<image href="file:///etc/passwd"></image></svg>', "<image>"),
        (HEAD + '<rect x="0" y="0" width="9" height="9" style="fill:url(#a)"></rect></svg>', "the colour 'url"),
        (HEAD + '<rect x="zero" y="0" width="9" height="9"></rect></svg>', "'zero' where numbers belong"),
        (HEAD + '<rect x="1e999" y="0" width="9" height="9"></rect></svg>', "where numbers belong"),
        (HEAD + '<path d="M 0 0 A 1 1 0 0 1 2 2"></path></svg>', "the path"),
        (HEAD + '<path d="M 0 0 L 1"></path></svg>', "the path"),
        (HEAD.replace("400 200", "0 200") + "</svg>", "no size"),
        (HEAD.replace(' viewBox="-10 -20 400 200"', "") + "</svg>", "where numbers belong"),
        (HEAD + "<g>" * 60 + "</g>" * 60 + "</svg>", "too deeply"),
    ],
)
def test_what_is_no_picture_of_a_behavior_is_refused(svg: str, problem: str) -> None:
    pytest.importorskip("reportlab", reason="what writes PDF is not installed")
    with pytest.raises(FlexcellError) as refused:
        pdf_of(svg)
    assert problem in str(refused.value)


def test_fonts_are_those_that_are_named_heavy_where_asked_and_no_letter_is_lost() -> None:
    pytest.importorskip("reportlab", reason="what writes PDF is not installed")
    fonts = FontChoice(font_folders())
    try:
        ((words, plain),) = fonts.pieces("grasp", ["Inter", "DejaVu Sans"], 400)
    except FlexcellError as error:
        pytest.skip(str(error))
    assert words == "grasp"
    if "DejaVuSans" in plain:
        assert Path(plain).stem == "DejaVuSans"
        assert [Path(name).stem for _, name in fonts.pieces("grasp", ["DejaVu Sans"], 620)] == ["DejaVuSans-Bold"]
        assert [Path(name).stem for _, name in fonts.pieces("a", ["DejaVu Sans Mono"], 400)] == ["DejaVuSansMono"]
    # A letter of a private area is in no font.
    assert [words for words, _ in fonts.pieces("a\uf8f0b", ["DejaVu Sans"], 400)] == ["a?b"]


def test_a_machine_without_fonts_is_said(tmp_path: Path) -> None:
    pytest.importorskip("reportlab", reason="what writes PDF is not installed")
    (tmp_path / "broken.ttf").write_bytes(b"none")
    with pytest.raises(FlexcellError, match=NO_FONT):
        FontChoice([tmp_path, tmp_path / "none"]).pieces("a", ["Inter"], 400)
    assert FontChoice([tmp_path]).pieces("", ["Inter"], 400) == []
