"""Six tasks at the page, done as a person does them: every click and every key press is counted.

Each has the same goal on any version of the page; what a version cannot do is left to the person, and said so.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from playwright.sync_api import Error, Locator, Page, expect

SOON_MS = 10_000

HOLD, MISS, QUESTION = "behaviors/tasks/hold.yaml", "behaviors/tasks/miss.yaml", "behaviors/tasks/question.yaml"
_HEAD = """flexcell: 1
name: {name}
cell: ../cells/dual_panda.yaml
outcomes: [done, failed]
success: [done]
root:
  machine:
    initial: open
    states:
      open: {{state: gripper.Open, with: {{gripper: left}}, transitions: {{opened: above, failed: failed}}}}
"""
_GRASP = """
      above:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: left_above_PLACE}, speed: 0.5}
        transitions: {reached: approach, failed: failed}
      approach:
        state: motion.MoveLinear
        with: {robot: left, target: {entry: left_PLACE}, speed_m_s: 0.25}
        transitions: {reached: grasp, failed: failed}
      grasp:
        state: gripper.Grasp
        with: {gripper: left, part: hca_north, width_m: 0.03, force_n: 30}
        transitions: {held: hold, missed: failed, failed: failed}
      hold: {state: flow.Wait, with: {duration_s: 3000}, transitions: {done: done}}
"""
_AGREE = """
      above:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: left_home}, speed: 0.5}
        autonomy: {reached: high}
        transitions: {reached: done, failed: failed}
"""
DOCUMENTS = {
    HOLD: _HEAD.format(name="hold") + _GRASP.replace("PLACE", "pick"),
    MISS: _HEAD.format(name="miss") + _GRASP.replace("PLACE", "place"),
    QUESTION: _HEAD.format(name="question") + _AGREE,
}


@dataclass
class Hand:
    """A person at a page; `clicks` and `keys` are what was pressed so far."""

    page: Page
    url: str
    clicks: int = 0
    keys: int = 0

    def click(self, target: Locator) -> None:
        """Press a mouse button once."""
        target.click()
        self.clicks += 1

    def button(self, name: str, within: Locator | None = None) -> None:
        """Press the button of this name."""
        self.click((within or self.page).get_by_role("button", name=name, exact=True).first)

    def press(self, key: str) -> None:
        """Press one key."""
        self.page.keyboard.press(key)
        self.keys += 1

    def type(self, text: str) -> None:
        """Press a key for each letter."""
        self.page.keyboard.type(text)
        self.keys += len(text)

    def open(self, path: str) -> None:
        """Begin a task at an address, which counts nothing."""
        self.page.goto(self.url + path)

    def start(self, behavior: str) -> str:
        """Start a run before a task, from outside of the page."""
        body: dict[str, object] = {"behavior": behavior, "parameters": {}}
        return str(self._asked("POST", "/api/v1/runs", body)["run"])

    def ended(self, run: str) -> None:
        """Wait until a run is over."""
        while self._asked("GET", f"/api/v1/runs/{run}")["status"] in ("running", "stopping"):
            self.page.wait_for_timeout(200)

    def _asked(self, method: str, path: str, body: object = None) -> dict[str, object]:
        return self.page.evaluate(
            "async ([method, path, body]) => (await fetch(path, { method, ...(body && "
            "{ body: JSON.stringify(body), headers: { 'content-type': 'application/json' } }) })).json()",
            [method, path, body],
        )


@dataclass(frozen=True, kw_only=True)
class Task:
    """`prepare` is not counted; `do` returns what the page does not do of it, in words."""

    name: str
    prepare: Callable[[Hand], None]
    do: Callable[[Hand], str]


def _state(hand: Hand) -> Locator:
    return hand.page.get_by_role("status", name="State of the run")


def at_home(hand: Hand) -> None:
    hand.open("/")
    expect(hand.page.get_by_role("link", name="hold").first).to_be_visible()


def comes(what: Locator) -> bool:
    """Whether a part comes by itself, soon."""
    try:
        what.wait_for(timeout=SOON_MS)
    except Error:
        return False
    return True


def approve(hand: Hand) -> str:
    """From the home page, start a behavior below full autonomy, and agree to what it asks."""
    page = hand.page
    hand.click(page.get_by_role("link", name="question").first)
    hand.button("Operation")
    hand.click(page.get_by_role("combobox", name="Autonomy at the start"))
    hand.click(page.get_by_role("option", name="low"))
    hand.button("Start")
    hand.click(page.get_by_role("button", name=re.compile("^Agree")).first)
    expect(page.get_by_role("region", name="The run asks")).to_have_count(0)
    return ""


def failed(hand: Hand) -> None:
    at_home(hand)
    hand.ended(hand.start(MISS))
    hand.open("/")


def find_cause(hand: Hand) -> str:
    """From the home page, until the innermost cause of the latest run can be read."""
    page = hand.page
    hand.click(page.get_by_role("link", name="miss").last)
    panel = page.get_by_role("region", name="How the run failed")
    if not comes(panel):
        hand.click(page.get_by_role("tab", name="Failure"))
    expect(panel.get_by_role("heading").first).to_be_visible()
    page.wait_for_timeout(1000)
    words_shown = panel.inner_text().lower()
    missing = [words for words in ("expected", "last good run") if words not in words_shown]
    return f"not shown: {', '.join(missing)}" if missing else ""


def holding(hand: Hand) -> None:
    hand.open("/")
    hand.start(HOLD)
    hand.open(f"/behaviors/{HOLD}")
    active = hand.page.locator(".react-flow__node[data-id='root/hold'] [data-status='active']")
    expect(active.first).to_be_visible(timeout=120_000)


def recover(hand: Hand) -> str:
    """Stop the cell while a part is held; empty the hand, go home, reset the parts, and start the behavior again."""
    page = hand.page
    hand.button("Stop the cell")
    guide = page.get_by_role("region", name="Recovery guide")
    if not comes(guide):
        return _recovered_by_hand(hand)
    for name in ("Release", "Go home"):
        hand.button(name, guide)
        hand.button(name, page.get_by_role("dialog"))
        expect(guide.get_by_role("button", name=name, exact=True)).to_have_count(0, timeout=120_000)
    hand.button("Reset parts", guide)
    hand.button("Release the stop", guide)
    hand.button("Release the stop", page.get_by_role("dialog"))
    hand.click(guide.get_by_role("button", name=re.compile("^(Restart|Start anew)$")).first)
    hand.button("Start")
    expect(_state(hand)).to_have_text("Running")
    return ""


def _recovered_by_hand(hand: Hand) -> str:
    """Without a guide: the page that teaches opens the hand, that of the behavior resets parts."""
    page = hand.page
    hand.click(page.get_by_role("link", name="Teach").first)
    hand.button("Open", page.get_by_role("group", name="Tool").or_(page.locator("[aria-label='Tool']")).first)
    page.go_back()
    hand.clicks += 1
    hand.button("Reset parts")
    hand.button("Start")
    return "go home; nothing says what is held, what is next, or that the cell is stopped"


def teach(hand: Hand) -> str:
    """Capture where the joints are, save that under a name, and let a state of a behavior go there."""
    page = hand.page
    hand.click(page.get_by_role("link", name="Teach").first)
    hand.button("Joints")
    hand.click(page.get_by_role("tab", name="Captures"))
    hand.click(page.get_by_role("textbox", name="Name", exact=True))
    hand.type("aside")
    hand.button("Save")
    expect(page.get_by_role("status", name="Saving")).to_contain_text("Saved as")
    hand.click(page.get_by_role("link", name="flexcell").first)
    hand.click(page.get_by_role("link", name="question").first)
    hand.click(page.locator(".react-flow__node[data-id='root/above']"))
    hand.button("Edit")
    field = page.get_by_role("combobox", name="target", exact=True)
    hand.click(field)
    hand.press("Control+A")
    hand.type("aside")
    hand.press("Enter")
    hand.press("Control+S")
    expect(page.locator(".react-flow__node[data-id='root/above']")).to_be_visible()
    return ""


def two_runs(hand: Hand) -> None:
    at_home(hand)
    for _ in range(2):
        hand.ended(hand.start(MISS))
    hand.open("/")


def compare(hand: Hand) -> str:
    """From the home page, until the first divergence of two past runs can be read."""
    page = hand.page
    hand.click(page.get_by_role("link", name="Past runs and recordings"))
    listed = page.get_by_role("list", name="Past runs")
    expect(listed.get_by_role("link").nth(1)).to_be_visible()
    ticks = listed.get_by_role("checkbox")
    if ticks.count() < 2:
        hand.click(listed.get_by_role("link").first)
        return "two past runs cannot be compared; each is opened and read alone"
    hand.click(ticks.nth(0))
    hand.click(ticks.nth(1))
    hand.button("Compare")
    expect(page.get_by_text(re.compile("diverge", re.IGNORECASE)).first).to_be_visible()
    return ""
