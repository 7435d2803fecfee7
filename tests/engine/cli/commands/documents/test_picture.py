"""`flexcell picture`: a whole behavior as a file, drawn by the program of the page in a JavaScript engine."""

from __future__ import annotations

import re
import shutil
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest

import hatch_build
from engine.editing.pictures import PROGRAM
from tests.engine.cli.command import flexcell

BEHAVIOR = Path(__file__).parents[5] / "behaviors" / "test_cylinder" / "test_cylinder.yaml"
SVG = "{http://www.w3.org/2000/svg}"
NOTE = """
canvas_notes:
  root:
    n1: {text: "Fill the <outlet> first", position: [0, -120], size: [200, 90], colour: green}
"""

pytestmark = pytest.mark.skipif(
    not (hatch_build.STATIC.parent / PROGRAM).is_file(), reason="the page is not built on this machine"
)


def drawn(text: str) -> list[str]:
    """The words in a picture."""
    return ["".join(each.itertext()) for each in ET.fromstring(text).iter(f"{SVG}text")]


def test_a_behavior_is_drawn_with_its_notes_in_either_theme(tmp_path: Path) -> None:
    pytest.importorskip("quickjs", reason="the JavaScript engine of the extra `picture` is not installed")
    shutil.copytree(BEHAVIOR.parent, tmp_path / "shop")
    file = tmp_path / "shop" / BEHAVIOR.name
    file.write_text(file.read_text() + NOTE)
    said = flexcell("picture", file.relative_to(tmp_path), "-o", "made/light.svg", cwd=tmp_path)
    assert (said.code, said.err) == (0, "wrote made/light.svg\n")
    light = (tmp_path / "made/light.svg").read_text()
    words = drawn(light)
    assert "Fill the <outlet> first" in words
    assert {"home", "drop_load", "expect_cylinder"} <= {each.split()[0] for each in words if each}
    assert flexcell("picture", file, "-o", "dark.svg", "--dark", cwd=tmp_path).code == 0
    dark = (tmp_path / "dark.svg").read_text()
    assert drawn(dark) == words
    assert re.findall(r"fill:#\w+", dark) != re.findall(r"fill:#\w+", light)
    again = flexcell("picture", file, "-o", "again.svg", cwd=tmp_path)
    assert again.code == 0
    assert (tmp_path / "again.svg").read_text() == light


def test_a_png_has_twice_as_many_pixels_and_other_names_are_refused(tmp_path: Path) -> None:
    pytest.importorskip("quickjs", reason="the JavaScript engine of the extra `picture` is not installed")
    pytest.importorskip("resvg_py", reason="what draws pixels is not installed")
    assert flexcell("picture", BEHAVIOR, "-o", "a.svg", cwd=tmp_path).code == 0
    said = flexcell("picture", BEHAVIOR, "-o", "a.png", cwd=tmp_path)
    assert said.code == 0, said.err
    made = (tmp_path / "a.png").read_bytes()
    assert made[:8] == b"\x89PNG\r\n\x1a\n"
    width = float(ET.fromstring((tmp_path / "a.svg").read_text()).attrib["width"])
    assert int.from_bytes(made[16:20]) == pytest.approx(2 * width, abs=2)
    said = flexcell("picture", BEHAVIOR, "-o", "a.gif", cwd=tmp_path)
    assert (said.code, said.err) == (2, "flexcell: a.gif is no picture (give a name that ends in .svg, .png or .pdf)\n")


@pytest.mark.parametrize("theme", [[], ["--dark"]])
def test_a_pdf_is_one_page_with_the_texts_and_colours_of_the_drawing(tmp_path: Path, theme: list[str]) -> None:
    pytest.importorskip("quickjs", reason="the JavaScript engine of the extra `picture` is not installed")
    pytest.importorskip("reportlab", reason="what writes PDF is not installed")
    pdfium: Any = pytest.importorskip("pypdfium2", reason="what reads PDF is not installed")
    for name in ("a.svg", "a.pdf"):
        said = flexcell("picture", BEHAVIOR, "-o", name, *theme, cwd=tmp_path)
        assert said.code == 0, said.err
    svg = ET.fromstring((tmp_path / "a.svg").read_text())
    document = pdfium.PdfDocument(tmp_path / "a.pdf")
    assert len(document) == 1
    page = document[0]
    size = [float(svg.attrib[side]) for side in ("width", "height")]
    # A pixel is the 96th part of an inch, a point the 72nd.
    assert page.get_size() == pytest.approx([0.75 * each for each in size])
    words = [
        each for text in svg.iter(f"{SVG}text") for each in "".join(f" {part}" for part in text.itertext()).split()
    ]
    assert sorted(page.get_textpage().get_text_bounded().split()) == sorted(words)
    left, top, *_ = map(float, svg.attrib["viewBox"].split())
    picture = page.render(scale=96 / 72).to_pil().convert("RGB")
    cards = [each for each in svg.iter(f"{SVG}rect") if "fill:#" in each.attrib["style"] and each.get("rx") == "10"]
    assert len(cards) > 20
    for card in cards:
        x, y, height = (float(card.attrib[name]) for name in ("x", "y", "height"))
        seen = picture.getpixel((round(x - left + 6), round(y - top + height / 3)))
        assert "#{:02x}{:02x}{:02x}".format(*seen) == card.attrib["style"][len("fill:") :][:7]


def test_containers_are_opened_by_name_and_by_level(tmp_path: Path) -> None:
    pytest.importorskip("quickjs", reason="the JavaScript engine of the extra `picture` is not installed")

    def names(*options: str) -> set[str]:
        said = flexcell("picture", BEHAVIOR, "-o", "a.svg", *options, cwd=tmp_path)
        assert said.code == 0, said.err
        return {each.split()[0] for each in drawn((tmp_path / "a.svg").read_text()) if each}

    closed, one = names("--depth", "0"), names("--depth", "0", "--open", "root/pick")
    assert {"pick", "water"} <= closed
    assert one - closed >= {"grip", "back_off"}
    assert "rinse" not in one
    assert {"grip", "rinse"} <= names("--depth", "1")
    said = flexcell("picture", BEHAVIOR, "-o", "b.svg", "--open", "root/pik", cwd=tmp_path)
    assert said.code == 2
    assert said.err.startswith("flexcell: --open root/pik: there is no such container (did you mean root/pick")
    said = flexcell("picture", BEHAVIOR, "-o", "b.svg", "--all", "--depth", "1", cwd=tmp_path)
    assert (said.code, said.err) == (2, "flexcell: --all and --depth say different things (give one of them)\n")
    assert not (tmp_path / "b.svg").exists()


def test_a_document_that_cannot_be_read_is_said(tmp_path: Path) -> None:
    said = flexcell("picture", "none.yaml", "-o", "a.svg", cwd=tmp_path)
    assert said.code == 2
    assert said.err == "flexcell: none.yaml:1:1: cannot read this file: No such file or directory (check its path)\n"
    (tmp_path / "empty.yaml").write_text("flexcell: 1\nname: x\noutcomes: [done]\n")
    said = flexcell("picture", "empty.yaml", "-o", "a.svg", cwd=tmp_path)
    assert (said.code, said.err) == (2, "flexcell: empty.yaml: this document has no nodes\n")
    assert not (tmp_path / "a.svg").exists()


def test_a_picture_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    pytest.importorskip("quickjs", reason="the JavaScript engine of the extra `picture` is not installed")
    (tmp_path / "file").write_text("")
    said = flexcell("picture", BEHAVIOR, "-o", "file/a.svg", cwd=tmp_path)
    assert said.code == 2
    assert said.err.startswith("flexcell: file/a.svg: the file cannot be written: ")
