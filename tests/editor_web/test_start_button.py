"""The Start button in a real browser, against a real session."""

from __future__ import annotations

from playwright.sync_api import Browser, expect

from tests.editor_web.browsing import opened_page
from tests.editor_web.workshop import NAP_ID, SHIFT_ID, Workshop

AT_ONCE = """
const observer = new MutationObserver(() => {
  const start = [...document.querySelectorAll('main button')].find((each) => each.textContent.trim() === 'Start')
  if (!start || start.disabled) return
  observer.disconnect()
  start.click()
})
observer.observe(document, { subtree: true, childList: true, attributes: true })
"""


def test_a_press_in_the_moment_in_which_the_button_is_drawn_starts_a_run(browser: Browser, shop: Workshop) -> None:
    """The form of the parameters is put into its pane later than the button into the head of the page."""
    with opened_page(browser, shop.running) as page:
        page.add_init_script(AT_ONCE)
        page.goto(f"{shop.running.url.rstrip('/')}/behaviors/{NAP_ID}")
        expect(page.get_by_role("status", name="State of the run")).to_contain_text("Running")
        assert len(shop.on_loop(shop.session.runs)) == 1


def test_enter_in_a_field_starts_one_run(browser: Browser, shop: Workshop) -> None:
    """As in any form."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}") as page:
        page.get_by_label("Dwell").fill("0.01")
        page.get_by_label("Dwell").press("Enter")
        expect(page.get_by_role("status", name="State of the run")).to_contain_text("Running")
        assert len(shop.on_loop(shop.session.runs)) == 1
