"""Who may enter: the tokens, the session cookie made from them, and the limit on wrong guesses."""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from engine.errors import FlexcellError

OPERATOR = "operator"
VIEWER = "viewer"


@dataclass(frozen=True, kw_only=True)
class Access:
    """The two secrets of one server: `operator` may do everything, `viewer` may look."""

    operator: str
    viewer: str

    def role_of_token(self, token: str) -> str | None:
        """Return the role a token opens, or None."""
        return self._match(token, {self.operator: OPERATOR, self.viewer: VIEWER})

    def role_of_session(self, session: str) -> str | None:
        """Return the role of a session cookie's value, or None."""
        return self._match(session, {self.session(OPERATOR): OPERATOR, self.session(VIEWER): VIEWER})

    def session(self, role: str) -> str:
        """Return the cookie value of a role; it outlives a restart, and ends when the token file is replaced."""
        token = self.operator if role == OPERATOR else self.viewer
        return hmac.new(token.encode(), f"flexcell session {role}".encode(), hashlib.sha256).hexdigest()

    @staticmethod
    def _match(given: str, known: dict[str, str]) -> str | None:
        found = None
        for secret, role in known.items():
            # Every secret is compared, so the time taken says nothing.
            if hmac.compare_digest(secret.encode(), given.encode("utf-8", "surrogateescape")):
                found = role
        return found


def load_access(file: Path) -> Access:
    """Read the tokens from `file`, or make them there, readable by the owner alone (mode 0600).

    Raises:
        FlexcellError: The file is readable by others, damaged, or cannot be written.
    """
    try:
        if not file.exists():
            _create(file)
        if os.name == "posix" and file.stat().st_mode & 0o077:
            raise FlexcellError(
                "the token file can be read by other users", where=file, hint=f"chmod 600 {file}, or delete it"
            )
        lines = file.read_text(encoding="ascii").split()
    except (OSError, UnicodeDecodeError) as error:
        raise FlexcellError(f"the token file cannot be used: {error}", where=file, hint="delete it") from error
    if len(lines) != 2 or min(map(len, lines)) < 32:
        raise FlexcellError(
            "the token file must hold two lines, operator and viewer token", where=file, hint="delete it"
        )
    return Access(operator=lines[0], viewer=lines[1])


def _create(file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    handle = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "w", encoding="ascii") as out:
        out.write(f"{secrets.token_urlsafe(32)}\n{secrets.token_urlsafe(32)}\n")


@dataclass(kw_only=True)
class AttemptLimit:
    """Allows `burst` wrong log-ins at once and one more every `refill_s` seconds."""

    now_s: Callable[[], float]
    burst: int = 10
    refill_s: float = 6.0
    _spent: float = field(default=0.0, init=False)
    _since_s: float = field(default=0.0, init=False)

    def wait_s(self) -> float:
        """Return how long the next attempt has to wait; 0 when it may come now."""
        self._refill()
        return max(0.0, (self._spent + 1.0 - self.burst) * self.refill_s)

    def failed(self) -> None:
        """Count one wrong attempt."""
        self._refill()
        self._spent += 1.0

    def _refill(self) -> None:
        now_s = self.now_s()
        self._spent = max(0.0, self._spent - (now_s - self._since_s) / self.refill_s)
        self._since_s = now_s
