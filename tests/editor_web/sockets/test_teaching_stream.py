"""What the page for teaching asks over HTTP, of an arm in physics: where it would be, and to go there slowly."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import httpx
import msgspec
import numpy as np
import pytest

from engine.messages.demonstrations import Trajectory
from engine.skills.dmp import LearnJointDmp
from engine.skills.entries import WriteEntry
from engine.skills.teaching import TeachNow
from tests.editor_web.limits import GUARD_S
from tests.editor_web.teach_site import TeachSite
from tests.robots.panda_arm import home

TIMES = np.linspace(0.0, 1.0, 101)
TURNED = home() + np.outer(0.5 - 0.5 * np.cos(np.pi * TIMES), (0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
LED = Trajectory(times_s=tuple(TIMES.tolist()), joints=tuple(map(tuple, TURNED.tolist())))


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """With a recording, and the primitive learned from it, in the store."""
    with TeachSite(host=loopback, project=tmp_path_factory.mktemp("taught")) as opened:
        learned = opened.call(opened.bus.call(LearnJointDmp(trajectory=LED), to="left"))
        entries: tuple[tuple[str, str, dict[str, Any]], ...] = (
            ("trajectory", "led", msgspec.to_builtins(LED)),
            ("dmp", "turn", msgspec.to_builtins(learned.dmp)),
            ("record", "note", {"text": "nothing"}),
        )
        for kind, name, value in entries:
            written = WriteEntry(kind=kind, name=name, value=value, tags=("tested",), by="me", reason="first")
            opened.call(opened.bus.call(written, to="store"))
        yield opened


@pytest.fixture
def http(site: TeachSite) -> Generator[httpx.Client]:
    """The operator."""
    headers = {"Authorization": f"Bearer {site.running.token}"}
    url = f"{site.running.url}api/v1/teach"
    with httpx.Client(base_url=url, headers=headers, trust_env=False, timeout=GUARD_S) as made:
        yield made


def test_entries_are_listed_with_their_last_change(http: httpx.Client) -> None:
    found = http.get("/entries", params={"text": "test", "kind": "dmp"}).json()
    assert found["total"] == 1
    (entry,) = found["entries"]
    assert (entry["name"], entry["tags"], entry["by"], entry["reason"]) == ("turn", ["tested"], "me", "first")
    assert http.get("/entries", params={"text": "tested", "limit": 1}).json()["total"] == 3


def test_a_capture_is_the_recording_beside_what_was_learned(http: httpx.Client, site: TeachSite) -> None:
    for pressed in (True, False):
        site.call(site.bus.call(TeachNow(callback="joint_dmp_save", robot="left", pressed=pressed), to="teach"))
        if pressed:
            site.call(site.go_home())
            site.call(site.turn(0.2))
    status = site.call(site.bus.call(TeachNow(callback="joint_save", robot="left"), to="teach"))
    motion, still = (capture.id for capture in status.captures)
    found = http.get("/fits", params={"arm": "left", "capture": motion}).json()
    shown, learned = found["demonstration"], found["primitive"]
    assert abs(learned["joints"][-1][0] - shown["joints"][-1][0]) < 0.01
    assert found["joint_fit"]["rms_rad"] < 0.01
    at = http.get("/fits", params={"arm": "left", "capture": still}).json()
    assert len(at["demonstration"]["joints"]) == 1
    assert at["primitive"] is None


@pytest.mark.parametrize(
    ("query", "words"),
    [
        ({"kind": "dmp", "name": "turning"}, "turning"),
        ({"kind": "record", "name": "note"}, "an entry of kind record has no poses"),
        ({"capture": 77}, "there is no capture 77"),
    ],
)
def test_what_has_no_place_is_refused_in_words(http: httpx.Client, query: dict[str, str], words: str) -> None:
    answer = http.get("/fits", params={"arm": "left", **query})
    assert answer.status_code == 422
    assert words in answer.json()["message"]


def test_a_recording_is_played_as_the_primitive_learned_from_it(http: httpx.Client, site: TeachSite) -> None:
    site.call(site.go_home())
    answer = http.post("/play", json={"arm": "left", "kind": "trajectory", "name": "led", "speed": 0.5})
    assert answer.json() == {"status": "succeeded", "cause": ""}
    assert abs(site.joints().position_rad[0] - TURNED[-1][0]) < 0.01


@pytest.mark.parametrize(
    "body",
    [
        {"arm": "left", "kind": "dmp", "name": "turn", "speed": 0.9},
        {"arm": "left", "kind": "dmp", "name": "turn"},
        {"arm": "left", "kind": "dmp", "name": "nobody", "speed": 0.1},
        {"arm": "middle", "kind": "dmp", "name": "turn", "speed": 0.1},
    ],
)
def test_what_is_too_fast_or_not_there_is_not_played(http: httpx.Client, body: dict[str, object]) -> None:
    assert http.post("/play", json=body).status_code == 422


def test_an_arm_that_holds_itself_is_not_pushed(http: httpx.Client) -> None:
    answer = http.post("/push", json={"arm": "left", "force_n": [0, 5, 0], "duration_s": 0.2})
    assert (answer.status_code, answer.json()["hint"]) == (422, "start hand guiding first")


def test_a_viewer_moves_nothing(site: TeachSite) -> None:
    headers = {"Authorization": f"Bearer {site.access.viewer}"}
    body = {"arm": "left", "kind": "dmp", "name": "turn", "speed": 0.1}
    answer = httpx.post(
        f"{site.running.url}api/v1/teach/play", json=body, headers=headers, trust_env=False, timeout=GUARD_S
    )
    assert answer.status_code == 403


def test_an_entry_gets_other_tags_unless_somebody_has_changed_it_meanwhile(http: httpx.Client, site: TeachSite) -> None:
    """Of its revision that the page has seen; the value stays."""
    written = WriteEntry(kind="record", name="label", value={"text": "something"}, by="me", reason="first")
    site.call(site.bus.call(written, to="store"))
    body = {"kind": "record", "name": "label", "tags": ["b", "a"], "revision": 1}
    assert http.post("/tags", json=body).status_code == 204
    (entry,) = http.get("/entries", params={"text": "label"}).json()["entries"]
    assert (entry["tags"], entry["revision"], entry["by"]) == (["a", "b"], 2, "the dashboard")
    late = http.post("/tags", json={**body, "tags": ["c"]})
    assert late.status_code in (409, 422)
    assert "revision" in late.json()["message"]
    for wrong in ({**body, "tags": ["A b"], "revision": 2}, {**body, "name": "nobody"}, {**body, "tags": ["x" * 65]}):
        assert http.post("/tags", json=wrong).status_code == 422


def test_what_an_entry_was_is_followed_by_its_revision(http: httpx.Client, site: TeachSite) -> None:
    """And one that never was is refused."""
    for turned in (0.1, 0.4):
        site.call(site.write_joints("aside", (turned, *home().tolist()[1:])))
    query = {"arm": "left", "kind": "joints", "name": "aside"}
    first, now = (
        http.get("/fits", params={**query, **more}).json()["demonstration"]["joints"][0][0]
        for more in ({"revision": "1"}, {})
    )
    assert (first, now) == (0.1, 0.4)
    gone = http.get("/fits", params={**query, "revision": "9"})
    assert (gone.status_code, "has no revision 9" in gone.json()["message"]) == (422, True)
