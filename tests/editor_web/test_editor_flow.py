"""Data flow, fixes of problems, references seen in place, and pictures, in a real browser."""

from __future__ import annotations

import base64
import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.bus import SkillBus
from engine.skills.entries import (
    EntryChanged,
    EntryHistory,
    EntryList,
    EntryRecord,
    ListEntries,
    ReadEntry,
    ReadHistory,
)
from tests.editor_web.browsing import Scheme, require_accessible
from tests.editor_web.editing import at_editor, card, file_text, idle, save
from tests.editor_web.test_editor_project import OUTER, OUTER_ID
from tests.editor_web.workshop import NAP_ID, SHIFT, SHIFT_ID, Workshop

FLOW_ID = "behaviors/flow.yaml"
FLOW = """\
flexcell: 1
name: flow
outcomes: [good, bad]
success: [good]
parameters:
  limit: {type: number, default: 2, unit: s}
root:
  machine:
    initial: choose
    states:
      choose: {state: test.Give, transitions: {a: set, b: show, c: bad}}
      set: {state: flow.SetValue, with: {value: "${limit}"}, out: {value: count}, transitions: {done: show}}
      show: {state: flow.Log, with: {message: "${count}"}, transitions: {done: good}}
"""


def open_text(page: Page) -> None:
    """Show the text beside the canvas."""
    page.keyboard.press("y")
    expect(page.locator(".cm-content")).to_be_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_is_seen_who_writes_a_key_who_reads_it_and_on_which_way_it_is_undefined(
    browser: Browser, shop: Workshop, scheme: Scheme
) -> None:
    (shop.project / FLOW_ID).write_text(FLOW, encoding="utf-8")
    with at_editor(browser, shop, FLOW_ID, scheme=scheme) as page:
        page.get_by_role("button", name=re.compile("^Data flow: writers")).click()
        panel = page.get_by_label("Data flow", exact=True).first
        expect(panel.get_by_role("button", name=re.compile("limit"))).to_contain_text("number, s")
        arrows = page.locator("[data-link]")
        expect(arrows).to_have_count(2)
        panel.get_by_role("button", name=re.compile("count")).click()
        expect(arrows).to_have_count(1)
        expect(page.locator("[data-link][data-unsure]")).to_have_count(1)
        expect(panel).to_contain_text("undefined on the path choose → show")
        require_accessible(page, f"data flow, {scheme}")
        panel.get_by_role("button", name=re.compile("^set output")).click()
        field = page.locator("input[aria-label='Output value is written to']")
        expect(field).to_be_focused()
        expect(field).to_have_value("count")


def test_the_form_of_a_node_tells_who_reads_what_it_writes(browser: Browser, shop: Workshop) -> None:
    (shop.project / FLOW_ID).write_text(FLOW, encoding="utf-8")
    with at_editor(browser, shop, FLOW_ID) as page:
        card(page, "root/set").click()
        page.get_by_role("button", name=re.compile("^Reads and writes")).click()
        section = page.get_by_role("region", name="Reads and writes")
        expect(section).to_contain_text("reads limit")
        expect(section).to_contain_text("from the behavior")
        section.get_by_role("button", name=re.compile("read by show")).click()
        expect(page.locator("[data-form] header")).to_contain_text("show")


def test_a_problem_is_mended_by_one_of_the_fixes_that_are_offered(browser: Browser, shop: Workshop) -> None:
    """In the list of problems, to which the form of the node leads; undo takes it back."""
    broken = SHIFT.replace("b: bad, c: bad}", "b: bad}").replace("duration_s: 3000", "duration: 3000")
    (shop.project / SHIFT_ID).write_text(broken, encoding="utf-8")
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.locator("[data-problem-count]").click()
        problems = page.get_by_label("Problems", exact=True)
        loose = problems.get_by_role("button", name=re.compile("outcome"))
        loose.click()
        require_accessible(page, "problems with fixes")
        problems.get_by_role("button", name="Connect c to bad").click()
        expect(loose).to_have_count(0)
        page.keyboard.press("Control+z")
        expect(problems.get_by_role("button", name="Connect c to bad")).to_be_visible()
        page.keyboard.press("Control+Shift+z")
        expect(loose).to_have_count(0)
        card(page, "root/rest").click()
        page.get_by_label("Problems of this node").get_by_role("button", name=re.compile("has no parameter")).click()
        problems.get_by_role("button", name="Rename it to duration_s").click()
        expect(page.locator("[data-problem-count]")).to_contain_text("No problems")
        save(page)
    mended = file_text(shop, SHIFT_ID)
    assert mended == SHIFT


def test_a_fix_is_offered_at_the_line_of_the_text(browser: Browser, shop: Workshop) -> None:
    (shop.project / SHIFT_ID).write_text(SHIFT.replace("flow.SetValue", "flow.SetValu"), encoding="utf-8")
    with at_editor(browser, shop, SHIFT_ID) as page:
        open_text(page)
        page.locator(".cm-lintRange-error").first.hover()
        page.locator(".cm-tooltip").get_by_role("button", name="Run flow.SetValue").click()
        idle(page)
        expect(card(page, "root/set")).to_contain_text("flow.SetValue")
        expect(page.locator("[data-problem-count]")).to_contain_text("No problems")


def test_a_behavior_that_is_referred_to_is_seen_in_place_and_opened_at_a_node(browser: Browser, shop: Workshop) -> None:
    """It cannot be changed there; the page of its own leads back."""
    (shop.project / OUTER_ID).write_text(OUTER, encoding="utf-8")
    with at_editor(browser, shop, OUTER_ID) as page:
        card(page, "root/nap").click()
        page.keyboard.press("o")
        inner = card(page, "root/nap/root/only")
        expect(inner).to_be_visible()
        expect(card(page, "root/nap")).to_contain_text("read only")
        # An edit beside it leaves it open.
        card(page, "root/nap").locator("[data-head]").click()
        page.keyboard.press("Control+d")
        idle(page)
        expect(card(page, "root/nap_2")).to_be_visible()
        expect(inner).to_be_visible()
        inner.click()
        page.keyboard.press("Delete")
        expect(page.locator("[data-notice]")).to_contain_text("part of another behavior")
        page.get_by_role("button", name="Open nap.yaml at this node").click()
        expect(page.locator("[data-editor-head]")).to_contain_text(NAP_ID)
        expect(page.locator("[data-form] header")).to_contain_text("only")
        page.get_by_title("Back to behaviors/outer.yaml").click()
        expect(page.locator("[data-editor-head]")).to_contain_text(OUTER_ID)
        expect(page.locator("[data-form] header")).to_contain_text("nap")
        card(page, "root/nap").click()
        page.keyboard.press("o")
        expect(inner).to_be_visible()
        page.keyboard.press("o")
        expect(inner).to_have_count(0)


def test_what_is_seen_in_place_follows_its_file(browser: Browser, shop: Workshop) -> None:
    (shop.project / OUTER_ID).write_text(OUTER, encoding="utf-8")
    with at_editor(browser, shop, OUTER_ID) as page:
        card(page, "root/nap").click()
        page.get_by_role("button", name="Show the contents here (O)").click()
        expect(card(page, "root/nap/root/only")).to_be_visible()
        nap = shop.project / NAP_ID
        nap.write_text(nap.read_text(encoding="utf-8").replace("only", "later"), encoding="utf-8")
        expect(card(page, "root/nap/root/later")).to_be_visible()


@pytest.mark.parametrize(("scheme", "canvas"), [("light", "#f8f9fb"), ("dark", "#13161b")])
def test_the_whole_behavior_is_exported_as_a_standalone_picture(
    browser: Browser, shop: Workshop, tmp_path: Path, scheme: Scheme, canvas: str
) -> None:
    """With what is inside of open containers, in the colours of the page, without anything from outside."""
    with at_editor(browser, shop, SHIFT_ID, scheme=scheme) as page:
        if card(page, "root/both/left").count() == 0:
            card(page, "root/both").click()
            page.keyboard.press("o")
            expect(card(page, "root/both/left")).to_be_visible()
        for words, file in (("Export as SVG", tmp_path / "a.svg"), ("Export as PNG", tmp_path / "a.png")):
            page.get_by_role("button", name="File", exact=True).click()
            with page.expect_download() as download:
                page.get_by_role("menuitem", name=words).click()
            assert download.value.suggested_filename == f"shift{file.suffix}"
            download.value.save_as(file)
        svg = (tmp_path / "a.svg").read_text(encoding="utf-8")
        drawn = ET.fromstring(svg)
        text = " ".join(drawn.itertext())
        for name in ("first", "set", "left", "right", "rest", "Ends with", "finished"):
            assert name in text
        assert "var(" not in svg
        assert re.search(r"(href|src)=|url\(|<script|<foreignObject", svg) is None
        wide, high = (float(drawn.attrib[side]) for side in ("width", "height"))
        size = page.evaluate(
            """async (url) => {
                const image = new Image(); image.src = url; await image.decode()
                const canvas = document.createElement('canvas'); canvas.width = canvas.height = 1
                const context = canvas.getContext('2d'); context.drawImage(image, 0, 0)
                const [r, g, b] = context.getImageData(0, 0, 1, 1).data
                return [image.width, image.height, '#' + [r, g, b].map((c) => c.toString(16).padStart(2, '0')).join('')]
            }""",
            "data:image/png;base64," + base64.b64encode((tmp_path / "a.png").read_bytes()).decode(),
        )
        assert size[0] == pytest.approx(2 * wide, abs=2)
        assert size[1] == pytest.approx(2 * high, abs=2)
        assert size[2] == canvas


@pytest.mark.parametrize(("scheme", "canvas"), [("light", "#f8f9fb"), ("dark", "#13161b")])
def test_the_whole_behavior_is_exported_as_a_pdf(
    browser: Browser, shop: Workshop, tmp_path: Path, scheme: Scheme, canvas: str
) -> None:
    """As it is on the page, not as it is saved: with an edit, and the words as words."""
    pytest.importorskip("reportlab", reason="what writes PDF is not installed")
    pdfium: Any = pytest.importorskip("pypdfium2", reason="what reads PDF is not installed")
    with at_editor(browser, shop, SHIFT_ID, scheme=scheme) as page:
        card(page, "root/set").click()
        page.keyboard.press("F2")
        page.keyboard.type("put")
        page.keyboard.press("Enter")
        expect(card(page, "root/put")).to_be_visible()
        idle(page)
        page.get_by_role("button", name="File", exact=True).click()
        with page.expect_download() as download:
            page.get_by_role("menuitem", name="Export as PDF").click()
        assert download.value.suggested_filename == "shift.pdf"
        download.value.save_as(tmp_path / "a.pdf")
    document = pdfium.PdfDocument(tmp_path / "a.pdf")
    assert (len(document), document.get_metadata_value("Title")) == (1, "shift")
    words = document[0].get_textpage().get_text_bounded()
    for name in ("first", "put", "left", "right", "rest", "Ends with", "finished"):
        assert name in words
    corner = document[0].render(scale=1).to_pil().convert("RGB").getpixel((2, 2))
    assert "#{:02x}{:02x}{:02x}".format(*corner) == canvas


class Shelf:
    """The services of a store with one entry."""

    def furnish(self, bus: SkillBus) -> None:
        """Put the services on a bus."""
        bus.advertise_service(ListEntries, self._list, namespace="store")
        bus.advertise_service(ReadEntry, self._read, namespace="store")
        bus.advertise_service(ReadHistory, self._history, namespace="store")

    async def _list(self, request: ListEntries) -> EntryList:
        del request
        return EntryList(entries=(("joints", "home", 3),))

    async def _read(self, request: ReadEntry) -> EntryRecord:
        value: dict[str, object] = {"joints": [0.0, -1.5707963], "names": ["turn", "lift"]}
        return EntryRecord(kind=request.kind, name=request.name, value=value, revision=3)

    async def _history(self, request: ReadHistory) -> EntryHistory:
        change = EntryChanged(
            kind=request.kind, name=request.name, revision=3, deleted=False, tags=("upright",), by="Ada",
            reason="taught anew", changed_unix_ms=1_700_000_000_000,
        )  # fmt: skip
        return EntryHistory(changes=(change,))


def test_an_entry_that_is_chosen_tells_what_is_in_it_and_who_changed_it_last(
    browser: Browser, tmp_path: Path, loopback: str
) -> None:
    with Workshop(host=loopback, project=tmp_path, furnish=Shelf().furnish) as shop:
        text = SHIFT.replace(
            "flow.SetValue, with: {value: 1}, transitions: {done: both}",
            "motion.MoveJoints, with: {robot: arm, target: {entry: home}}, transitions: {reached: both, failed: bad}",
        )
        (shop.project / SHIFT_ID).write_text(text, encoding="utf-8")
        with at_editor(browser, shop, SHIFT_ID) as page:
            card(page, "root/set").click()
            page.get_by_text("About home").click()
            details = page.locator("[data-entry]")
            expect(details).to_contain_text("revision 3")
            expect(details).to_contain_text("by Ada")
            expect(details).to_contain_text("upright")
            expect(details).to_contain_text("lift-1.571 (-90.0°)")


def test_a_note_is_written_on_the_canvas_and_stays_in_the_file(browser: Browser, shop: Workshop) -> None:
    """On a node and on the whole behavior; emptied, it goes."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        card(page, "root/set").click()
        page.keyboard.press("n")
        page.keyboard.type("Ask Ada first")
        page.keyboard.press("Control+Enter")
        idle(page)
        note = page.get_by_role("button", name="Note on set: Ask Ada first")
        expect(note).to_be_visible()
        require_accessible(page, "a note", part="[data-canvas]")
        page.get_by_role("button", name="Notes on the canvas").click()
        expect(note).to_have_count(0)
        page.get_by_role("button", name="Notes on the canvas").click()
        save(page)
        assert "notes: {root/set: Ask Ada first}" in file_text(shop, SHIFT_ID)
        page.locator(".react-flow__pane").click(position={"x": 5, "y": 5})
        note.click()
        page.get_by_role("textbox", name="Note on set").fill("")
        page.locator(".react-flow__pane").click(position={"x": 5, "y": 5})
        expect(note).to_have_count(0)
        page.keyboard.press("n")
        page.keyboard.type("Night shift only")
        page.keyboard.press("Control+Enter")
        expect(page.get_by_role("button", name="Note on the behavior: Night shift only")).to_be_visible()
        save(page)
    assert file_text(shop, SHIFT_ID) == SHIFT + "notes: {root: Night shift only}\n"


def test_a_free_note_is_written_moved_and_coloured_and_stays_in_the_file(browser: Browser, shop: Workshop) -> None:
    """By the keyboard and by the mouse, each way undone as one step; it lies below the nodes."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.locator(".react-flow__pane").click(position={"x": 5, "y": 5})
        page.keyboard.press("Shift+N")
        page.keyboard.type("Night shift only")
        page.keyboard.press("Control+Enter")
        note = page.get_by_role("button", name="Yellow note on the canvas of the behavior: Night shift only")
        expect(note).to_be_focused()
        page.keyboard.press("Shift+ArrowRight")
        idle(page)
        require_accessible(page, "a free note", part="[data-canvas]")
        page.get_by_role("button", name="Make the note pink").click()
        idle(page)
        note = page.get_by_role("button", name=re.compile("^Pink note"))
        before = note.bounding_box()
        first = card(page, "root/set").bounding_box()
        assert before is not None
        assert first is not None
        page.mouse.move(before["x"] + 30, before["y"] + 30)
        page.mouse.down()
        page.mouse.move(first["x"] + 40, first["y"] + 50, steps=8)
        page.mouse.up()
        idle(page)
        after = note.bounding_box()
        assert after is not None
        assert after["x"] == pytest.approx(first["x"] + 10, abs=3)
        # Its tools go with the keyboard; then a node takes the pointer where both are.
        page.keyboard.press("Escape")
        card(page, "root/set").click(position={"x": 30, "y": 10})
        expect(card(page, "root/set").locator("[data-selected]")).to_be_visible()
        save(page)
        made = file_text(shop, SHIFT_ID)
        assert made.startswith(SHIFT)
        head, _, note_line = made.removeprefix(SHIFT).partition("    ")
        assert head == "canvas_notes:\n  root:\n"
        assert re.match(r"n\w{5}: \{text: Night shift only, position: ", note_line)
        assert note_line.endswith("size: [210, 90], colour: pink}\n")
        for _ in range(4):
            page.keyboard.press("Control+z")
        expect(note).to_have_count(0)
        save(page)
    assert file_text(shop, SHIFT_ID) == SHIFT


def test_two_fingers_zoom_the_canvas_and_a_long_press_asks_what_to_add(browser: Browser, shop: Workshop) -> None:
    """As on a tablet: touches as the browser gets them."""
    with at_editor(browser, shop, SHIFT_ID) as first:
        state = first.context.storage_state()
    context = browser.new_context(
        locale="en-US", viewport={"width": 1024, "height": 768}, has_touch=True, is_mobile=True, storage_state=state
    )
    page = context.new_page()
    page.goto(f"{shop.running.url}edit/{SHIFT_ID}")
    expect(page.locator(".react-flow[data-in-place]")).to_be_visible()
    idle(page)
    fingers: Any = context.new_cdp_session(page)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        touches = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})

    canvas = page.locator("[data-canvas]").bounding_box()
    assert canvas is not None
    x, y = canvas["x"] + canvas["width"] / 2, canvas["y"] + canvas["height"] - 40
    viewport = page.locator(".react-flow__viewport")
    zoom = "(element) => new DOMMatrix(getComputedStyle(element).transform).a"
    before = viewport.evaluate(zoom)
    touch("touchStart", (x - 40, y), (x + 40, y))
    for step in range(1, 9):
        touch("touchMove", (x - 40 - 8 * step, y), (x + 40 + 8 * step, y))
    touch("touchEnd")
    page.wait_for_function(
        f"(before) => ({zoom})(document.querySelector('.react-flow__viewport')) > 1.5 * before", arg=before
    )
    page.get_by_role("button", name="Show all (F)").tap()
    idle(page)
    expect(card(page, "root/first")).to_be_in_viewport()
    touch("touchStart", (canvas["x"] + 12, canvas["y"] + canvas["height"] - 12))
    expect(page.get_by_role("dialog").get_by_role("option").first).to_be_visible()
    touch("touchEnd")
    context.close()
