"""Who has the page open: the last word of each page counts, and goes with its connection."""

from __future__ import annotations

from editor_web.live.presence import Presence, PresenceRoster, ShowPresence


def test_pages_are_present_with_what_they_show_until_they_leave() -> None:
    changes: list[int] = []
    roster = PresenceRoster(changed=lambda: changes.append(1), now_s=lambda: 50.0)
    one, two = roster.new_page(), roster.new_page()
    roster.show(one, "operator", ShowPresence(name=" Ada ", document="behaviors/a.yaml", node="root/go", edits=True))
    roster.show(two, "viewer", ShowPresence())
    roster.show(two, "viewer", ShowPresence())
    roster.operate(one, "operator", "r1")
    ada = Presence(
        page=one, name="Ada", role="operator", document="behaviors/a.yaml", node="root/go", edits=True,
        operates="r1", since_s=50.0,
    )  # fmt: skip
    assert roster.present == (ada, Presence(page=two, name="Viewer 2", role="viewer"))
    assert len(changes) == 3
    roster.show(one, "operator", ShowPresence(name="Ada"))
    assert (roster.present[0].document, roster.present[0].operates) == ("", "r1")
    roster.operate(one, "operator", "")
    roster.leave(two)
    roster.leave(two)
    assert roster.present == (Presence(page=one, name="Ada", role="operator"),)
    assert len(changes) == 6
