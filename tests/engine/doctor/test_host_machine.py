"""What is told of the machine: each subject once, with what it means where less is possible."""

from __future__ import annotations

import pytest

from engine.doctor import host_machine


def test_each_subject_is_there_and_a_note_says_what_to_do() -> None:
    found = {each.subject: each for each in host_machine.machine()}
    assert set(found) >= {"cores", "punctuality", "real time", "graphics"}
    assert all(each.state for each in found.values())
    assert all(each.advice for each in found.values() if each.condition != "ok")
    assert "a sleep of 1 ms ends" in found["punctuality"].state


def test_without_graphics_images_are_computed_by_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(_name: str) -> None:
        return None

    monkeypatch.setattr(host_machine, "find_library", nothing)
    found = {each.subject: each for each in host_machine.machine()}["graphics"]
    assert (found.condition, found.state) == ("note", "images of cameras are computed by rays")
    assert "libegl1" in found.advice
