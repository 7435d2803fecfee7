"""Login sessions of browsers: random secrets, stored as hashes, with expiry; and single-use login links."""

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
"""Maximum lifetime of a session after the login."""
IDLE_LIMIT_S = 12 * 3600.0
"""Maximum idle time of a session, without requests or open pages."""
LINK_LIMIT_S = 3600.0
"""Lifetime of an unused login link."""
_MAX_SESSIONS = 200
_MAX_LINKS = 100
# A killed server loses at most this much of the recorded use of its sessions.
_SAVE_PERIOD_S = 300.0
_log = logging.getLogger("flexcell.sessions")


class SessionRecord(msgspec.Struct, frozen=True, kw_only=True, rename={"started_s": "began_s"}):
    """One session as stored on disk; times in seconds since 1970."""

    digest: str
    role: Role
    started_s: float
    used_s: float


class _SessionFile(msgspec.Struct, frozen=True, kw_only=True):
    tokens: str
    sessions: tuple[SessionRecord, ...]


@dataclass(kw_only=True, eq=False)
class LoginSession:
    """The session of one logged-in browser: its role, and the callbacks for its end."""

    digest: str
    role: Role
    started_s: float
    used_s: float
    is_over: bool = False
    _on_end: set[Callable[[], None]] = field(default_factory=set[Callable[[], None]], init=False)

    def left_s(self, now_s: float) -> float:
        """Return the remaining lifetime without further use."""
        return min(self.started_s + ABSOLUTE_LIMIT_S, self.used_s + IDLE_LIMIT_S) - now_s

    @contextmanager
    def calling(self, on_end: Callable[[], None]) -> Generator[None]:
        """Call a function if the session ends within the block."""
        self._on_end.add(on_end)
        try:
            yield
        finally:
            self._on_end.discard(on_end)

    def end(self) -> None:
        """End the session: its websockets and requests close."""
        self.is_over = True
        for on_end in tuple(self._on_end):
            on_end()


class LoginSessions:
    """The sessions of one server.

    Only hashes of session and link secrets are kept, so that neither memory nor file contains valid credentials.
    Sessions end on the event loop's thread only, where their connections are closed.

    Args:
        file: File that keeps sessions over a restart; None keeps them in memory only.
        tokens: Hash of the server's access tokens; sessions created under other tokens are dropped.
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
        """Load the sessions of the previous server; with a damaged file, all users log in again."""
        if self._file is None:
            return
        try:
            kept = msgspec.json.decode(self._file.read_bytes(), type=_SessionFile)
        except FileNotFoundError:
            return
        except (OSError, msgspec.DecodeError) as error:
            _log.warning("%s cannot be read; all users have to log in again: %s", self._file, error)
            return
        if kept.tokens != self._tokens:
            return
        for each in kept.sessions:
            session = LoginSession(digest=each.digest, role=each.role, started_s=each.started_s, used_s=each.used_s)
            if session.left_s(self._now_s()) > 0:
                self._sessions[each.digest] = session

    def begin(self, role: Role) -> str:
        """Begin a session and return the secret for the browser's cookie."""
        secret, now_s = secrets.token_urlsafe(32), self._now_s()
        digest = _digest(secret)
        with self._changing:
            self._sessions[digest] = LoginSession(digest=digest, role=role, started_s=now_s, used_s=now_s)
            while len(self._sessions) > _MAX_SESSIONS:
                self._drop(min(self._sessions.values(), key=lambda each: each.used_s))
            self.save()
        return secret

    def find(self, secret: str) -> LoginSession | None:
        """Return the session of a secret and record its use; None if it does not exist or has ended."""
        session = self._sessions.get(_digest(secret))
        if session is None:
            return None
        if session.left_s(self._now_s()) <= 0:
            self.end(session)
            return None
        self.use(session)
        return session

    def use(self, session: LoginSession) -> None:
        """Record the use of a session, which restarts its idle time."""
        session.used_s = self._now_s()
        if abs(session.used_s - self._saved_s) > _SAVE_PERIOD_S:
            self.save()

    def left_s(self, session: LoginSession) -> float:
        """Return the remaining lifetime of a session without further use."""
        return session.left_s(self._now_s())

    def end(self, session: LoginSession) -> None:
        """End a session permanently; its connections close."""
        self._drop(session)
        self.save()

    def new_link(self, role: Role) -> str:
        """Return a single-use login token, valid for `LINK_LIMIT_S`."""
        token, now_s = secrets.token_urlsafe(32), self._now_s()
        with self._changing:
            self._links = {key: link for key, link in self._links.items() if now_s - link[1] < LINK_LIMIT_S}
            while len(self._links) >= _MAX_LINKS:
                del self._links[next(iter(self._links))]
            self._links[_digest(token)] = (role, now_s)
        return token

    def take_link(self, token: str) -> Role | None:
        """Return the role of a login link and invalidate it; None if it was used, has expired or is unknown."""
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
            SessionRecord(digest=each.digest, role=each.role, started_s=each.started_s, used_s=each.used_s)
            for each in self._sessions.values()
        )
        try:
            _write_private(file, msgspec.json.encode(_SessionFile(tokens=self._tokens, sessions=records)))
            self._is_save_failing = False
        except OSError as error:
            # A full disk must not prevent a login, for example to stop the cell.
            if not self._is_save_failing:
                _log.warning("%s cannot be written; sessions end with this server: %s", file, error)
            self._is_save_failing = True

    def _drop(self, session: LoginSession) -> None:
        self._sessions.pop(session.digest, None)
        session.end()


def _digest(secret: str) -> str:
    # The secrets are random and long: a plain hash cannot be inverted, and a lookup by hash reveals no prefix.
    return hashlib.sha256(secret.encode("utf-8", "surrogateescape")).hexdigest()


def _write_private(file: Path, content: bytes) -> None:
    part = file.with_name(f"{file.name}.part")
    part.unlink(missing_ok=True)
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "wb") as stream:
        stream.write(content)
    part.replace(file)
