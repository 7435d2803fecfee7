"""What the tests of the page do with a browser themselves."""

from __future__ import annotations

from playwright.sync_api import Browser

from tests.editor_web.browsing import FADED

PAGE = """
<style>
  @keyframes turn { to { rotate: 1turn } }
  .turning { animation: turn 1s infinite }
  .fading { color: rgb(1, 1, 1); transition: color 3600s }
  .skipped { content-visibility: auto }
</style>
<p class="turning">turns</p>
<p class="fading">in sight</p>
<div style="height: 9000px"></div>
<div class="skipped"><p class="fading">out of sight</p></div>
"""
COLOURS = "() => [...document.querySelectorAll('.fading')].map((each) => getComputedStyle(each).color)"
CHANGED = f"""() => {{
    ({COLOURS})()
    document.querySelectorAll('.fading').forEach((each) => {{ each.style.color = 'rgb(9, 9, 9)' }})
    return ({COLOURS})()
}}"""


def test_what_fades_is_ended_at_once_whatever_turns_endlessly_beside_it(browser: Browser) -> None:
    """Before colours are looked at; nothing is waited for."""
    page = browser.new_page()
    page.set_content(PAGE)
    assert page.evaluate(CHANGED)[0] == "rgb(1, 1, 1)"
    page.evaluate(FADED)
    assert page.evaluate(COLOURS) == ["rgb(9, 9, 9)"] * 2
    page.close()
