"""Log-in sessions of browsers: random, kept as hashes only, with an end; and links that log in once."""

from __future__ import annotations

import hashlib
import logging
import os
import secrets
import threading
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from editor_web.security.authentication import Role

ABSOLUTE_LIMIT_S = 7 * 24 * 3600.0
"""A session ends this long after the log-in, used or not."""
IDLE_LIMIT_S = 12 * 3600.0
"""A session that no request or page uses for this long ends."""
LINK_LIMIT_S = 3600.0
"""A log-in link that was not opened for this long opens nothing."""
_MAX_SESSIONS = 200
_MAX_LINKS = 100
# A server that is killed forgets at most so much of the use of its sessions.
_SAVE_PERIOD_S = 300.0
_log = logging.getLogger("flexcell.sessions")


class SessionRecord(msgspec.Struct, frozen=True, kw_only=True):
    """One session as it is kept on disk; times in seconds since 1970."""

    digest: str
    role: Role
    began_s: float
    used_s: float


class _SessionFile(msgspec.Struct, frozen=True, kw_only=True):
    tokens: str
    sessions: tuple[SessionRecord, ...]


@dataclass(kw_only=True, eq=False)
class LoginSession:
    """One logged-in browser: its role, and who is told when it ends."""

    digest: str
    role: Role
    began_s: float
    used_s: float
    is_over: bool = False
    _on_end: set[Callable[[], None]] = field(default_factory=set[Callable[[], None]], init=False)

    def left_s(self, now_s: float) -> float:
        """Return how long it goes on if nobody uses it any more."""
        return min(self.began_s + ABSOLUTE_LIMIT_S, self.used_s + IDLE_LIMIT_S) - now_s

    @contextmanager
    def calling(self, on_end: Callable[[], None]) -> Generator[None]:
        """Have a function called when the session ends within the block."""
        self._on_end.add(on_end)
        try:
            yield
        finally:
            self._on_end.discard(on_end)

    def end(self) -> None:
        """End it: everything that is open in its name closes."""
        self.is_over = True
        for told in tuple(self._on_end):
            told()


class LoginSessions:
    """The sessions of one server.

    Only hashes of what browsers and links carry are kept, so neither memory nor file logs anybody in. Sessions
    end on the thread of the event loop only, where what is open in their name is closed.

    Args:
        file: Where sessions outlive the server; None keeps them in memory only.
        tokens: Hash of the tokens that open the server; sessions made under others are forgotten.
        now_s: Wall clock in seconds since 1970.
    """

    def __init__(self, *, file: Path | None, tokens: str, now_s: Callable[[], float] = time.time) -> None:
        self._file = file
        self._tokens = tokens
        self._now_s = now_s
        self._sessions: dict[str, LoginSession] = {}
        self._links: dict[str, tuple[Role, float]] = {}
        self._saved_s = now_s()
        self._is_save_failing = False
        self._changing = threading.RLock()

    def load(self) -> None:
        """Take up the sessions of the server before; a damaged file means that all log in again."""
        if self._file is None:
            return
        try:
            kept = msgspec.json.decode(self._file.read_bytes(), type=_SessionFile)
        except FileNotFoundError:
            return
        except (OSError, msgspec.DecodeError) as error:
            _log.warning("%s cannot be read, so everybody logs in again: %s", self._file, error)
            return
        if kept.tokens != self._tokens:
            return
        for each in kept.sessions:
            session = LoginSession(digest=each.digest, role=each.role, began_s=each.began_s, used_s=each.used_s)
            if session.left_s(self._now_s()) > 0:
                self._sessions[each.digest] = session

    def begin(self, role: Role) -> str:
        """Begin a session and return the secret that its browser carries."""
        secret, now_s = secrets.token_urlsafe(32), self._now_s()
        digest = _digest(secret)
        with self._changing:
            self._sessions[digest] = LoginSession(digest=digest, role=role, began_s=now_s, used_s=now_s)
            while len(self._sessions) > _MAX_SESSIONS:
                self._drop(min(self._sessions.values(), key=lambda each: each.used_s))
            self.save()
        return secret

    def find(self, secret: str) -> LoginSession | None:
        """Return the session of a secret and note its use; None for one that never was or is over."""
        session = self._sessions.get(_digest(secret))
        if session is None:
            return None
        if session.left_s(self._now_s()) <= 0:
            self.end(session)
            return None
        self.use(session)
        return session

    def use(self, session: LoginSession) -> None:
        """Note that a session is in use, which keeps it from ending of idleness."""
        session.used_s = self._now_s()
        if abs(session.used_s - self._saved_s) > _SAVE_PERIOD_S:
            self.save()

    def left_s(self, session: LoginSession) -> float:
        """Return how long a session goes on if nobody uses it any more."""
        return session.left_s(self._now_s())

    def end(self, session: LoginSession) -> None:
        """End a session for good; what is open in its name closes."""
        self._drop(session)
        self.save()

    def new_link(self, role: Role) -> str:
        """Return a token that logs in once, within `LINK_LIMIT_S`."""
        token, now_s = secrets.token_urlsafe(32), self._now_s()
        with self._changing:
            self._links = {key: link for key, link in self._links.items() if now_s - link[1] < LINK_LIMIT_S}
            while len(self._links) >= _MAX_LINKS:
                del self._links[next(iter(self._links))]
            self._links[_digest(token)] = (role, now_s)
        return token

    def take_link(self, token: str) -> Role | None:
        """Return the role that a log-in link opens and spend it; None for one that is spent, too old or unknown."""
        with self._changing:
            role, made_s = self._links.pop(_digest(token), (None, 0.0))
        return role if self._now_s() - made_s < LINK_LIMIT_S else None

    def save(self) -> None:
        """Write all sessions to the file, readable by its owner only."""
        self._saved_s = self._now_s()
        if self._file is None:
            return
        with self._changing:
            self._write(self._file)

    def _write(self, file: Path) -> None:
        records = tuple(
            SessionRecord(digest=each.digest, role=each.role, began_s=each.began_s, used_s=each.used_s)
            for each in self._sessions.values()
        )
        try:
            _write_private(file, msgspec.json.encode(_SessionFile(tokens=self._tokens, sessions=records)))
            self._is_save_failing = False
        except OSError as error:
            # A full disk must not keep anybody from logging in, to stop the cell for instance.
            if not self._is_save_failing:
                _log.warning("%s cannot be written, so sessions end with this server: %s", file, error)
            self._is_save_failing = True

    def _drop(self, session: LoginSession) -> None:
        self._sessions.pop(session.digest, None)
        session.end()


def _digest(secret: str) -> str:
    # The secrets are random and long: a plain hash cannot be searched for, and a look-up by it tells no prefix.
    return hashlib.sha256(secret.encode("utf-8", "surrogateescape")).hexdigest()


def _write_private(file: Path, content: bytes) -> None:
    part = file.with_name(f"{file.name}.part")
    part.unlink(missing_ok=True)
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "wb") as stream:
        stream.write(content)
    part.replace(file)
