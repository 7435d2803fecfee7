"""What is kept of a real device: its mode in one word, what has stopped it last, and who has enabled it."""

from __future__ import annotations

import pytest

from engine.messages.device_state import DeviceMode, DeviceState
from robots.drivers.device_history import DeviceHistory


def state(problem: str = "", *, connected: bool = True, fault: str = "") -> DeviceState:
    return DeviceState(
        driver="robotiq", address="here:1", connected=connected, enabled=not problem, problem=problem, fault=fault
    )


@pytest.fixture
def clock() -> list[float]:
    return [100.0]


@pytest.fixture
def history(clock: list[float]) -> DeviceHistory:
    return DeviceHistory(unix_s=lambda: clock[0])


def modes(history: DeviceHistory, *states: DeviceState) -> list[DeviceMode]:
    return [history.complete(each).mode for each in states]


def test_the_mode_says_whether_it_was_ever_enabled(history: DeviceHistory) -> None:
    before, enabled, after = state("motion is not enabled"), state(), state("protective stop")
    assert modes(history, before, enabled, after) == ["reading", "enabled", "stopped"]


def test_a_fault_of_its_own_and_a_loss_have_modes_of_their_own(history: DeviceHistory) -> None:
    faulty, lost = state("fault: too hot", fault="too hot"), state("link cut", connected=False)
    assert modes(history, faulty, lost) == ["fault", "lost"]


def test_the_last_cause_stays_after_it_was_enabled_again(history: DeviceHistory, clock: list[float]) -> None:
    history.complete(state())
    clock[0] = 200.0
    history.complete(state("protective stop"))
    clock[0] = 300.0
    history.enabled(by="Anna", reason="looked at it")
    kept = history.complete(state())
    assert (kept.last_cause, kept.last_cause_unix_s) == ("protective stop", 200.0)
    assert (kept.enabled_by, kept.enabled_for, kept.mode) == ("Anna", "looked at it", "enabled")


def test_the_same_cause_again_has_the_later_time(history: DeviceHistory, clock: list[float]) -> None:
    for clock[0], problem in ((1.0, ""), (2.0, "protective stop"), (3.0, ""), (4.0, "protective stop")):
        kept = history.complete(state(problem))
    assert kept.last_cause_unix_s == 4.0


def test_a_loss_that_names_its_duration_is_one_loss(history: DeviceHistory, clock: list[float]) -> None:
    for clock[0] in (1.0, 2.0):
        kept = history.complete(state(f"no message for {clock[0]:.0f} s", connected=False))
    assert (kept.last_cause, kept.last_cause_unix_s) == ("no message for 1 s", 1.0)


def test_a_device_that_waits_to_be_enabled_has_no_cause(history: DeviceHistory) -> None:
    kept = history.complete(state("motion is not enabled"))
    assert (kept.last_cause, kept.last_cause_unix_s) == ("", 0.0)


def test_a_reason_with_line_ends_is_kept_as_one_line(history: DeviceHistory) -> None:
    history.enabled(by="eve\r\nERROR arm", reason="looked\n2026-11-27 INFO all is well\u2028\x85\x1b[2Jok")
    kept = history.complete(state())
    assert (kept.enabled_by, kept.enabled_for) == ("eve ERROR arm", "looked 2026-11-27 INFO all is well [2Jok")
