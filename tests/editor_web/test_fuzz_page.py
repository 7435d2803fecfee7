"""Names, descriptions, log texts, reasons and entries that are scripts: shown as the text they are, on every page."""

from __future__ import annotations

import json
from collections.abc import Generator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.bus import SkillBus
from engine.runtime.run_options import RunOptions
from engine.skills.entries import EntryList, ListEntries
from tests.editor_web.browsing import opened_page
from tests.editor_web.workshop import Workshop

SCRIPT = "<img src=x onerror='window.harmed=1'><script>window.harmed=1</script>"
QUOTED = "\"'><svg onload=window.harmed=1>`{window.harmed=1}`"
LINK = "javascript:window.harmed=1"
# Turns round what is written after it, where nothing keeps it apart.
BIDI = "\u202eevil\u2066"
HARM_ID = "behaviors/harm.yaml"
HARM = f"""
flexcell: 1
name: {json.dumps(SCRIPT)}
description: {json.dumps(SCRIPT + QUOTED + LINK)}
parameters:
  value: {{type: string, default: {json.dumps(SCRIPT)}, description: {json.dumps(QUOTED)}}}
outcomes: [good]
success: [good]
root:
  machine:
    initial: say
    states:
      say:
        state: flow.Log
        with: {{message: {json.dumps(SCRIPT + QUOTED)}}}
        transitions: {{done: turn}}
      turn: {{state: flow.Log, with: {{message: {json.dumps(BIDI)}}}, transitions: {{done: rest}}}}
      rest: {{state: flow.Wait, with: {{duration_s: 3000}}, transitions: {{done: good}}}}
"""
# A node cannot be named so, yet the file is shown with its errors.
REFUSED_ID = "behaviors/refused.yaml"
REFUSED = HARM.replace("say:", f"{json.dumps(SCRIPT)}:").replace("turn:", f"{json.dumps(BIDI)}:")


def harmful_entries(bus: SkillBus) -> None:
    """A store whose entries are named so."""

    async def list_entries(request: ListEntries) -> EntryList:
        del request
        return EntryList(entries=(("pose", SCRIPT, 1), ("pose", BIDI, 1)))

    bus.advertise_service(ListEntries, list_entries, namespace="store")


@pytest.fixture
def harmful(tmp_path: Path, loopback: str) -> Generator[Workshop]:
    """A session with one behavior of which everything is a script."""
    with Workshop(host=loopback, project=tmp_path, furnish=harmful_entries) as shop:
        (tmp_path / HARM_ID).write_text(HARM, encoding="utf-8")
        (tmp_path / REFUSED_ID).write_text(REFUSED, encoding="utf-8")
        yield shop


def require_unharmed(page: Page) -> None:
    """Nothing ran, no element was made of a name, and no link leads into a script."""
    assert page.evaluate("() => window.harmed") is None
    assert page.locator("img[src=x], svg[onload], a[href^=javascript]").count() == 0


def test_scripts_in_names_texts_and_reasons_stay_text(browser: Browser, harmful: Workshop) -> None:
    """List, run page with parameters, graph, log, lock and stop."""
    with opened_page(browser, harmful.running) as page:
        expect(page.get_by_role("link", name=SCRIPT).first).to_be_visible()
        require_unharmed(page)
        run = harmful.start(HARM_ID, supervision=RunOptions(start_paused=True))
        page.goto(f"{harmful.running.url}behaviors/{HARM_ID}")
        expect(page.locator("h1")).to_contain_text(SCRIPT)
        expect(page.get_by_label("value", exact=True)).to_have_value(SCRIPT)
        control = harmful.on_loop(lambda: harmful.session.control(run))
        harmful.on_loop(lambda: control.lock("root/say", SCRIPT + QUOTED))
        harmful.on_loop(control.resume)
        expect(page.get_by_role("log")).to_contain_text(SCRIPT + QUOTED)
        page.locator(".react-flow__node[data-id='root/say'] [data-node]").click()
        expect(page.get_by_role("region", name="Node root/say")).to_contain_text(f"Locked: {SCRIPT}")
        require_unharmed(page)
        harmful.call(harmful.session.stop(run, reason=SCRIPT))
        expect(page.get_by_role("log")).to_contain_text(f"stop requested: {SCRIPT}")
        require_unharmed(page)


@pytest.mark.parametrize("document", [HARM_ID, REFUSED_ID])
def test_scripts_in_a_document_stay_text_in_the_editor(browser: Browser, harmful: Workshop, document: str) -> None:
    """Canvas, text, problems, palette of states and entries; also where the text is no valid behavior."""
    with opened_page(browser, harmful.running, f"/edit/{document}") as page:
        if document == HARM_ID:
            expect(page.locator(".react-flow__node[data-id='root/say']").first).to_be_visible()
            page.get_by_role("tab", name="Behavior").click()
            require_unharmed(page)
        else:
            page.get_by_role("tab", name="Problems").click()
            expect(page.get_by_text("not in the allowed form").first).to_be_visible()
        page.locator("body").press("y")
        expect(page.get_by_role("textbox", name="Text of the behavior")).to_contain_text("onerror")
        require_unharmed(page)
        page.locator("body").press("Control+k")
        expect(page.get_by_role("dialog").get_by_role("option").first).to_be_visible()
        require_unharmed(page)


def test_the_policy_of_the_page_stops_what_would_slip_through(browser: Browser, harmful: Workshop) -> None:
    """Even markup that found its way into the page cannot run anything, nor send anything elsewhere."""
    with opened_page(browser, harmful.running, quiet=False) as page:
        expect(page.get_by_role("link", name=SCRIPT).first).to_be_visible()
        page.evaluate(
            """([script, link]) => {
                window.stopped = new Set()
                addEventListener('securitypolicyviolation', (e) => window.stopped.add(e.effectiveDirective))
                const place = document.body.appendChild(document.createElement('div'))
                const framed = `<iframe srcdoc="${script.replaceAll('"', '')}"></iframe>`
                place.innerHTML = `${script}${framed}<a href="${link}">x</a>`
                place.querySelector('a').click()
                const made = document.body.appendChild(document.createElement('script'))
                made.textContent = 'window.harmed = 1'
                fetch('http://127.0.0.2:1/').catch(() => window.stopped.add('fetch'))
            }""",
            [SCRIPT, LINK],
        )
        directives = ["script-src-attr", "script-src-elem", "connect-src", "fetch"]
        page.wait_for_function("(expected) => expected.every((each) => window.stopped.has(each))", arg=directives)
        assert page.evaluate("() => window.harmed") is None


def test_a_name_cannot_turn_round_what_stands_beside_it(browser: Browser, harmful: Workshop) -> None:
    """Control characters of writing direction end with the element they are in."""
    harmful.start(HARM_ID)
    with opened_page(browser, harmful.running, f"/behaviors/{HARM_ID}") as page:
        expect(page.get_by_role("log")).to_contain_text(BIDI)
        open_ended = page.evaluate(
            """(name) => [...document.querySelectorAll('body *')]
                .filter((each) => [...each.childNodes].some((c) => c.nodeType === 3 && c.data.includes(name)))
                .filter((each) => getComputedStyle(each).display.startsWith('inline')
                    && !getComputedStyle(each).unicodeBidi.startsWith('isolate')
                    && !getComputedStyle(each).display.includes('block'))
                .map((each) => each.outerHTML.slice(0, 120))""",
            BIDI,
        )
        assert open_ended == []
