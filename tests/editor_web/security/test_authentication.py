"""Tokens, sessions and the limit on wrong guesses."""

from __future__ import annotations

import stat
from pathlib import Path

import pytest

from editor_web.security.authentication import OPERATOR, VIEWER, AttemptLimiter, load_access_tokens
from engine.errors import FlexcellError


def test_the_token_file_is_made_once_and_for_its_owner_only(tmp_path: Path) -> None:
    """A second start reads the same tokens; mode 0600."""
    file = tmp_path / "deep" / "tokens"
    first = load_access_tokens(file)
    assert load_access_tokens(file) == first
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert first.operator != first.viewer
    assert len(first.operator) >= 43


def test_a_token_file_that_others_can_read_is_refused(tmp_path: Path) -> None:
    """The message says which file and what to do."""
    file = tmp_path / "tokens"
    load_access_tokens(file)
    file.chmod(0o644)
    with pytest.raises(FlexcellError, match=r"can be read by other users.*chmod 600"):
        load_access_tokens(file)


@pytest.mark.parametrize("content", [b"", b"short\nshort\n", b"\xff\xfe", b"x" * 40])
def test_a_damaged_token_file_is_refused(tmp_path: Path, content: bytes) -> None:
    """Never fall back to an empty or guessable token."""
    file = tmp_path / "tokens"
    file.touch(mode=0o600)
    file.write_bytes(content)
    with pytest.raises(FlexcellError, match="token file"):
        load_access_tokens(file)


def test_each_token_opens_its_own_role_and_nothing_else_opens_any(tmp_path: Path) -> None:
    """Tokens and garbage."""
    access = load_access_tokens(tmp_path / "tokens")
    assert access.role_of_token(access.operator) == OPERATOR
    assert access.role_of_token(access.viewer) == VIEWER
    for wrong in ("", "x", access.operator[:-1], access.fingerprint(), "ü\udcff"):
        assert access.role_of_token(wrong) is None


def test_wrong_tokens_are_limited_and_the_limit_refills() -> None:
    """A burst of three, then one every ten seconds; what comes too early makes the wait no longer."""
    now_s = [100.0]
    limit = AttemptLimiter(now_s=lambda: now_s[0], burst=3, refill_s=10.0)
    assert [limit.failed("peer") for _ in range(3)] == [0, 0, 0]
    assert [limit.failed("peer") for _ in range(50)] == [pytest.approx(10.0)] * 50
    now_s[0] += 10.0
    assert limit.failed("peer") == 0
    assert limit.failed("peer") > 0


def test_each_peer_is_limited_by_itself() -> None:
    """And however many there are, only so many are remembered."""
    limit = AttemptLimiter(now_s=lambda: 0.0, burst=1)
    assert [limit.failed("one"), limit.failed("other")] == [0, 0]
    assert limit.failed("one") > 0
    for number in range(5000):
        limit.failed(f"peer {number}")
    assert limit.failed("one") == 0
