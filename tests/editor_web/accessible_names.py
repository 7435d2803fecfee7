"""What a screen reader gets of a page: its controls, each with role, name and the named groups around it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from playwright.sync_api import Page

CONTROLS = {
    *("button", "ToggleButton", "PopUpButton", "DisclosureTriangle", "link", "tab"),
    *("textbox", "searchbox", "spinbutton", "combobox", "checkbox", "radio", "switch", "slider", "splitter"),
    *("menuitem", "menuitemcheckbox", "menuitemradio"),
}
"""Roles of Chromium. Options of a list and items of a tree are left out: their position tells them apart."""
GROUPS = {
    *("alertdialog", "application", "article", "banner", "complementary", "contentinfo", "dialog", "figure", "form"),
    *("grid", "group", "list", "listbox", "listitem", "log", "main", "menu", "menubar", "navigation", "radiogroup"),
    *(
        "Date",
        "region",
        "row",
        "search",
        "status",
        "table",
        "tablist",
        "tabpanel",
        "toolbar",
        "tree",
        "treegrid",
        "treeitem",
    ),
}
"""Roles that a screen reader says when it enters them; they count where they have a name."""

Control = tuple[str, str, tuple[str, ...]]
"""Role, name, and the named groups around it, the outermost first."""


def controls_of(page: Page) -> Iterator[Control]:
    """Return every control that is exposed now; the 3D view, a document of its own, is left out."""
    session: Any = page.context.new_cdp_session(page)
    answer: dict[str, Any] = session.send("Accessibility.getFullAXTree")
    session.detach()
    nodes = {node["nodeId"]: node for node in answer["nodes"]}
    for node in nodes.values():
        if not node["ignored"] and _role(node) in CONTROLS:
            yield _role(node), _name(node), tuple(_groups(node, nodes))


def require_unique_names(page: Page, what: str) -> None:
    """No two controls that are exposed at once have one role and name, unless named groups tell them apart."""
    counts = Counter(controls_of(page))
    assert counts, f"{what}: there are no controls"
    found = [f"{count} x {role} {name!r} in {groups}" for (role, name, groups), count in counts.items() if count > 1]
    assert found == [], f"{what}: {found}"


def _groups(node: dict[str, Any], nodes: dict[str, dict[str, Any]]) -> Iterator[str]:
    around = nodes.get(node.get("parentId", ""))
    if around is None:
        return
    yield from _groups(around, nodes)
    if around["ignored"] or _role(around) not in GROUPS:
        return
    # Chromium leaves the name of a row, which is its text, to the screen reader.
    name = _name(around) or (" ".join(_texts(around, nodes)) if _role(around) == "row" else "")
    if name:
        yield f"{_role(around)} {name}"


def _texts(node: dict[str, Any], nodes: dict[str, dict[str, Any]]) -> Iterator[str]:
    if _role(node) == "StaticText":
        yield _name(node)
        return
    for child in node.get("childIds", ()):
        if child in nodes:
            yield from _texts(nodes[child], nodes)


def _role(node: dict[str, Any]) -> str:
    return str(node.get("role", {}).get("value", ""))


def _name(node: dict[str, Any]) -> str:
    return str(node.get("name", {}).get("value", "")).strip()
