"""Authentication: the permanent access tokens of a server, and the rate limit for wrong tokens."""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

from engine.errors import FlexcellError

Role = Literal["operator", "viewer"]
OPERATOR: Final = "operator"
VIEWER: Final = "viewer"
_MAX_PEERS = 1000


@dataclass(frozen=True, kw_only=True)
class AccessTokens:
    """The two access tokens of one server: `operator` has full access, `viewer` is read-only."""

    operator: str
    viewer: str

    def role_of_token(self, token: str) -> Role | None:
        """Return the role of a token; None for a wrong token."""
        return self._match(token, {self.operator: OPERATOR, self.viewer: VIEWER})

    def fingerprint(self) -> str:
        """Return a hash of both tokens; sessions created under other tokens end."""
        return hashlib.sha256(f"{self.operator} {self.viewer}".encode()).hexdigest()

    @staticmethod
    def _match(given: str, known: dict[str, Role]) -> Role | None:
        matched: Role | None = None
        for secret, role in known.items():
            # Every secret is compared, so that the timing reveals nothing.
            if hmac.compare_digest(secret.encode(), given.encode("utf-8", "surrogateescape")):
                matched = role
        return matched


def load_access_tokens(file: Path) -> AccessTokens:
    """Read the tokens from `file`, or create them there, readable by the owner only (mode 0600).

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
    return AccessTokens(operator=lines[0], viewer=lines[1])


def _create(file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    handle = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "w", encoding="ascii") as out:
        out.write(f"{secrets.token_urlsafe(32)}\n{secrets.token_urlsafe(32)}\n")


@dataclass(kw_only=True)
class AttemptLimiter:
    """Limits wrong tokens per peer: `burst` at once, then one every `refill_s` seconds.

    It counts wrong tokens only: all programs of a machine share one address, so wrong tokens of one program must not
    block the right token of another.
    """

    now_s: Callable[[], float]
    burst: int = 10
    refill_s: float = 6.0
    _attempts: OrderedDict[str, tuple[float, float]] = field(
        default_factory=OrderedDict[str, tuple[float, float]], init=False
    )

    def failed(self, peer: str) -> float:
        """Count one wrong token of a peer and return its waiting time in seconds; 0 within the burst."""
        now_s = self.now_s()
        count, since_s = self._attempts.pop(peer, (0.0, now_s))
        left = max(0.0, count - (now_s - since_s) / self.refill_s)
        wait_s = max(0.0, (left + 1.0 - self.burst) * self.refill_s)
        # Attempts during the waiting time do not count, otherwise a busy peer would wait forever.
        self._attempts[peer] = (left if wait_s > 0 else left + 1.0, now_s)
        while len(self._attempts) > _MAX_PEERS:
            self._attempts.popitem(last=False)
        return wait_s
