"""Splits URScript into tokens, and finds where a program that arrives in pieces ends."""

from __future__ import annotations

import re
from dataclasses import dataclass

from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import UrscriptError

_TOKEN = re.compile(
    r"""(?P<space>[ \t\r]+|\#[^\n]*)
      | (?P<line>\n)
      | (?P<number>(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?)
      | (?P<pose>p\[)
      | (?P<name>[A-Za-z_][A-Za-z0-9_]*)
      | (?P<text>"[^"\n]*"|'[^'\n]*')
      | (?P<operator>==|!=|<=|>=|[-+*/%<>=()\[\],:])""",
    re.VERBOSE,
)
_COMMENT_OR_TEXT = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'|#.*")
_BLOCK = re.compile(r"\b(def|sec|thread|if|while|end)\b")
_BLOCK_START = re.compile(r"\s*(def|sec)\b")


@dataclass(frozen=True, slots=True)
class Token:
    """One token: its kind, its text and its line."""

    kind: str
    text: str
    line: int


def tokenize(source: str) -> list[Token]:
    """Return the tokens, without line ends, spaces and comments, and an `end of text` behind them."""
    tokens: list[Token] = []
    line = 1
    position = 0
    while position < len(source):
        match = _TOKEN.match(source, position)
        if match is None:
            raise UrscriptError(f"unexpected character {source[position]!r}", line)
        kind = str(match.lastgroup)
        if kind == "line":
            line += 1
        elif kind != "space":
            tokens.append(Token(kind, match.group(), line))
        position = match.end()
    return [*tokens, Token("end of text", "", line)]


class ProgramSplitter:
    """Cuts a stream of text into programs: `def` and `sec` up to their `end`, and any other line by itself."""

    def __init__(self, most_characters: int = 4_000_000) -> None:
        self._most = most_characters
        self._rest = ""
        self._lines: list[str] = []
        self._size = 0
        self._depth = 0

    def feed(self, text: str) -> list[str]:
        """Return the programs that are complete now; raises UrscriptError where one is too long."""
        programs: list[str] = []
        *lines, self._rest = (self._rest + text).split("\n")
        self._size += len(text)
        if self._size > self._most:
            raise UrscriptError(f"a program of more than {self._most} characters")
        for line in lines:
            if not self._lines and not line.strip():
                continue
            if not self._lines and not _BLOCK_START.match(line):
                programs.append(line)
                continue
            self._lines.append(line)
            for word in _BLOCK.findall(_COMMENT_OR_TEXT.sub("", line)):
                self._depth += -1 if word == "end" else 1
            if self._depth <= 0:
                programs.append("\n".join(self._lines))
                self._lines, self._depth = [], 0
        if programs and not self._lines:
            self._size = len(self._rest)
        return programs
