"""Changed Python modules of the project's own states are followed by open pages, in a browser, without a restart."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, expect

from tests.editor_web.browsing import until
from tests.editor_web.editing import at_editor, card
from tests.editor_web.workshop import Workshop
from tests.engine.project_folder import STATE, ProjectFolder

ONLY_ID = "behaviors/only.yaml"
LONG_STATE = STATE.replace(
    '        return Outcome("done")', '        await ctx.clock.sleep(3000)\n        return Outcome("done")'
)


def with_outcomes(text: str, *outcomes: str) -> str:
    """The module whose state has these outcomes."""
    return text.replace('("done",)', repr(outcomes))


def test_a_changed_class_is_followed_and_a_broken_one_is_a_finding(
    browser: Browser, loopback: str, tmp_path: Path
) -> None:
    """Outcomes, findings and catalogue of the open editor; the class from before stays where the file is broken."""
    folder = ProjectFolder(tmp_path)
    module = folder.module()
    folder.allow(module)
    folder.behavior("only", f"{module}:Nod")
    file = tmp_path / f"{module}.py"
    with Workshop(host=loopback, project=tmp_path) as shop, at_editor(browser, shop, ONLY_ID) as page:
        lost = card(page, "root/only").locator(".react-flow__handle[data-handleid='lost']")
        problems = page.locator("[data-problem-count]")
        expect(lost).to_have_count(0)
        expect(problems).to_contain_text("No problems")
        file.write_text(with_outcomes(STATE, "done", "lost"), encoding="utf-8")
        expect(lost).to_have_count(1)
        expect(problems).to_contain_text("1 error")
        file.write_text(f"{STATE}\nraise ValueError('half written')\n", encoding="utf-8")
        expect(problems).to_contain_text("1 warning")
        page.get_by_role("tab", name="Problems").click()
        line = STATE.count("\n") + 2
        expect(page.locator("[data-inspector]")).to_contain_text(f"{module}.py:{line}")
        expect(page.locator("[data-inspector]")).to_contain_text("half written")
        expect(lost).to_have_count(1)
        file.write_text(STATE, encoding="utf-8")
        expect(lost).to_have_count(0)
        expect(problems).to_contain_text("No problems")


def test_a_run_keeps_its_classes_and_pages_follow_once_it_is_over(
    browser: Browser, loopback: str, tmp_path: Path
) -> None:
    folder = ProjectFolder(tmp_path)
    module = folder.module(LONG_STATE)
    folder.allow(module)
    folder.behavior("only", f"{module}:Nod")
    with Workshop(host=loopback, project=tmp_path) as shop:
        run = shop.start(ONLY_ID)
        with at_editor(browser, shop, ONLY_ID) as page:
            states = shop.session.documents.states
            (tmp_path / f"{module}.py").write_text(with_outcomes(LONG_STATE, "done", "lost"), encoding="utf-8")
            assert states.is_due()
            assert shop.on_loop(lambda: shop.session.executes_classes_of({module}))
            shop.call(shop.session.stop(run, reason="enough"))
            until(page, lambda: not states.is_due())
            expect(card(page, "root/only").locator(".react-flow__handle[data-handleid='lost']")).to_have_count(1)
            assert not shop.on_loop(lambda: shop.session.executes_classes_of({module}))
