"""The dashboard answers within the limit of the whole question, or it does not answer."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from robots.drivers.universal_robots import ur_dashboard
from robots.drivers.universal_robots.ur_dashboard import ask_dashboard

GREETING = b"Connected: Universal Robots Dashboard Server\n"


class SlowDashboard:
    """A connection whose pieces take a second each; one that has a shorter time limit gets none."""

    def __init__(self, *pieces: bytes) -> None:
        self._pieces: Iterator[bytes] = iter(pieces)
        self._limit_s = 0.0
        self.now_s = 100.0
        self.sent: list[bytes] = []

    def set_timeout(self, timeout_s: float) -> None:
        self._limit_s = timeout_s

    def send(self, data: bytes) -> None:
        self.sent.append(data)

    def receive(self, most: int) -> bytes:
        self.now_s += min(1.0, self._limit_s)
        if self._limit_s < 1.0:
            raise TimeoutError
        return next(self._pieces)

    def close(self) -> None:
        """Nothing is open."""


def asked(monkeypatch: pytest.MonkeyPatch, dashboard: SlowDashboard, *, limit_s: float) -> str:
    def connected(*_: object, **_options: object) -> SlowDashboard:
        return dashboard

    monkeypatch.setattr(ur_dashboard, "TcpConnection", connected)
    monkeypatch.setattr(ur_dashboard, "time", SimpleNamespace(monotonic=lambda: dashboard.now_s))
    return ask_dashboard("host", "stop", limit_s=limit_s)


def test_a_question_is_answered_within_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    dashboard = SlowDashboard(GREETING, b"Stop", b"ped\n")
    assert asked(monkeypatch, dashboard, limit_s=3.5) == "Stopped"
    assert dashboard.sent == [b"stop\n"]


def test_a_dashboard_whose_bytes_come_one_by_one_does_not_prolong_the_question(monkeypatch: pytest.MonkeyPatch) -> None:
    """A control process that waits for it would be called silent."""
    dashboard = SlowDashboard(GREETING, *(b"." for _ in range(100)))
    assert asked(monkeypatch, dashboard, limit_s=3.5) == ""
    assert dashboard.now_s == pytest.approx(103.5)
