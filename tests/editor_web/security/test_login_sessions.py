"""Sessions of browsers: random, with an end, kept as hashes; and links that log in once."""

from __future__ import annotations

import stat
from pathlib import Path

import pytest

from editor_web.security.authentication import OPERATOR, VIEWER
from editor_web.security.login_sessions import ABSOLUTE_LIMIT_S, IDLE_LIMIT_S, LINK_LIMIT_S, LoginSessions


class WallClock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now_s = 1_000_000.0

    def __call__(self) -> float:
        """Return the time in seconds."""
        return self.now_s


@pytest.fixture
def clock() -> WallClock:
    """A clock that stands still."""
    return WallClock()


@pytest.fixture
def sessions(clock: WallClock) -> LoginSessions:
    """Sessions in memory."""
    return LoginSessions(file=None, tokens="t", now_s=clock)


def test_each_log_in_is_a_session_of_its_own(sessions: LoginSessions) -> None:
    """Two of one role are told apart, and nothing else is one."""
    first, second = sessions.begin(OPERATOR), sessions.begin(OPERATOR)
    assert first != second
    assert min(len(first), len(second)) >= 43
    found = sessions.find(first)
    assert found is not None
    assert (found.role, found is sessions.find(second)) == (OPERATOR, False)
    for wrong in ("", first[:-1], found.digest, "ü\udcff"):
        assert sessions.find(wrong) is None


def test_a_session_that_is_used_ends_at_last(sessions: LoginSessions, clock: WallClock) -> None:
    """After a week, though there was a request every hour."""
    secret = sessions.begin(VIEWER)
    end_s = clock.now_s + ABSOLUTE_LIMIT_S
    while clock.now_s + 3600 < end_s:
        clock.now_s += 3600
        assert sessions.find(secret) is not None
    clock.now_s = end_s + 1
    assert sessions.find(secret) is None


def test_a_session_that_nobody_uses_ends_earlier(sessions: LoginSessions, clock: WallClock) -> None:
    """And stays over when the clock is put back."""
    secret = sessions.begin(VIEWER)
    clock.now_s += IDLE_LIMIT_S + 1
    assert sessions.find(secret) is None
    clock.now_s -= IDLE_LIMIT_S
    assert sessions.find(secret) is None


def test_whoever_is_open_is_notified_of_the_end(sessions: LoginSessions) -> None:
    """Of this session only, and only while open."""
    secret, other = sessions.begin(OPERATOR), sessions.begin(OPERATOR)
    told: list[str] = []
    session, different = sessions.find(secret), sessions.find(other)
    assert session is not None
    assert different is not None
    with session.calling(lambda: told.append("closed before")):
        pass
    with session.calling(lambda: told.append("open")), different.calling(lambda: told.append("another")):
        sessions.end(session)
    assert (told, session.is_over, different.is_over) == (["open"], True, False)
    assert sessions.find(secret) is None


def test_sessions_outlive_the_server_and_the_file_logs_nobody_in(tmp_path: Path, clock: WallClock) -> None:
    """Readable by the owner, hashes only."""
    file = tmp_path / "sessions"
    before = LoginSessions(file=file, tokens="t", now_s=clock)
    kept, ended = before.begin(OPERATOR), before.begin(VIEWER)
    over = before.find(ended)
    assert over is not None
    before.end(over)
    content = file.read_text(encoding="utf-8")
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert kept not in content
    after = LoginSessions(file=file, tokens="t", now_s=clock)
    after.load()
    found = after.find(kept)
    assert found is not None
    assert (found.role, after.find(ended)) == (OPERATOR, None)


def test_new_tokens_end_all_sessions(tmp_path: Path) -> None:
    """So deleting the token file logs everybody out."""
    file = tmp_path / "sessions"
    secret = LoginSessions(file=file, tokens="t").begin(OPERATOR)
    after = LoginSessions(file=file, tokens="other")
    after.load()
    assert after.find(secret) is None


@pytest.mark.parametrize(
    "content", [b"", b"{}", b"[" * 100_000, b'{"tokens": "t", "sessions": [{"role": "god"}]}', b"\xff"]
)
def test_a_damaged_file_logs_everybody_out_and_says_so(
    tmp_path: Path, content: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    """It lets nobody in, and keeps the server from nothing."""
    file = tmp_path / "sessions"
    file.write_bytes(content)
    sessions = LoginSessions(file=file, tokens="t")
    sessions.load()
    assert str(file) in caplog.text
    assert sessions.find(sessions.begin(OPERATOR)) is not None


def test_a_full_disk_keeps_nobody_from_logging_in(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """It is said once."""
    sessions = LoginSessions(file=tmp_path / "none" / "sessions", tokens="t")
    assert all(sessions.find(sessions.begin(OPERATOR)) for _ in range(3))
    assert caplog.text.count("cannot be written") == 1


def test_a_link_logs_in_once(sessions: LoginSessions, clock: WallClock) -> None:
    """Within an hour."""
    first, second, late = sessions.new_link(OPERATOR), sessions.new_link(VIEWER), sessions.new_link(OPERATOR)
    assert (sessions.take_link(first), sessions.take_link(first)) == (OPERATOR, None)
    assert (sessions.take_link(second), sessions.take_link("")) == (VIEWER, None)
    clock.now_s += LINK_LIMIT_S + 1
    assert sessions.take_link(late) is None


def test_neither_sessions_nor_links_pile_up(sessions: LoginSessions, clock: WallClock) -> None:
    """The oldest go."""
    secrets, links = list[str](), list[str]()
    for _ in range(300):
        clock.now_s += 1
        secrets.append(sessions.begin(VIEWER))
        links.append(sessions.new_link(VIEWER))
    assert sum(sessions.find(secret) is not None for secret in secrets) == 200
    assert sum(sessions.take_link(link) is not None for link in links) == 100
    assert sessions.find(secrets[-1]) is not None
