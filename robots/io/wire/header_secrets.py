"""Takes what proves who asks out of the lines of HTTP headers, as their bytes pass by in pieces."""

from __future__ import annotations

_SECRET = (
    b"authorization",
    b"proxy-authorization",
    b"authentication-info",
    b"proxy-authentication-info",
    b"cookie",
    b"set-cookie",
)
_LONGEST_NAME = 40
NOT_CAPTURED = b" (not captured)"
"""What stands in the place of such a value."""


class HeaderSecrets:
    """One direction of one connection; the bytes of everything else, bodies included, pass unchanged.

    Credentials, also the digest of a password, and cookies of a session are replaced. A line waits as long as it can
    become one of these.
    """

    def __init__(self) -> None:
        self._waiting = b""
        self._is_secret = False
        self._is_begun = False

    def passed(self, data: bytes) -> bytes:
        """Return what may be written of these bytes and of those that waited."""
        *lines, begun = data.split(b"\n")
        pieces = [line + b"\n" for line in lines] + ([begun] if begun else [])
        return b"".join(map(self._take, pieces))

    def rest(self) -> bytes:
        """Return what waits at the end of the connection: the beginning of a name."""
        rest, self._waiting = self._waiting, b""
        return rest

    def _take(self, piece: bytes) -> bytes:
        """Return what may be written of a line or a part of one."""
        ends = piece.endswith(b"\n")
        if self._is_begun:
            written = _line_end(piece) if self._is_secret else piece
        else:
            line = self._waiting + piece
            if not ends and _may_become_secret(line):
                self._waiting = line
                return b""
            self._waiting, self._is_begun = b"", True
            name, colon, _ = line.partition(b":")
            # A line that begins with a space goes on with the value before.
            goes_on = self._is_secret and line[:1] in (b" ", b"\t")
            self._is_secret = goes_on or name.strip().lower() in _SECRET
            shown = b"" if goes_on else name + colon
            written = shown + NOT_CAPTURED + _line_end(piece) if self._is_secret else line
        self._is_begun = not ends
        return written


def _may_become_secret(line: bytes) -> bool:
    name = line.lstrip().lower()
    return b":" not in line and len(line) < _LONGEST_NAME and any(each.startswith(name.rstrip()) for each in _SECRET)


def _line_end(piece: bytes) -> bytes:
    return piece[len(piece.rstrip(b"\r\n")) :]
