"""The fonts of this machine that a PDF can hold: found by the families that a picture names."""

from __future__ import annotations

import os
import struct
import sys
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

from engine.editing.pictures.picture_package import picture_package
from engine.errors import FlexcellError

NO_FONT = "there is no font on this machine to write names with"
INSTALL_FONT = "install one, such as `fonts-dejavu-core`, or write an SVG"
_SUFFIX = ".ttf"
_BOLD = ("-bold", "bd", "b", " bold")
_REGULAR = ("-regular", "")
_FILE_NAMES = {"Consolas": "consola"}
"""Of families whose files are called otherwise."""
_MOST_OTHERS = 50
"""To open a font takes some 30 ms."""
_LEAST_BOLD = 501
"""What is heavier than medium is written bold, as browsers choose among two weights."""


def font_folders() -> tuple[Path, ...]:
    """Return the folders in which this system keeps its fonts."""
    home = Path.home()
    if sys.platform == "win32":
        local = Path(os.environ.get("LOCALAPPDATA", home))
        return Path(os.environ.get("WINDIR", "C:/Windows"), "Fonts"), local / "Microsoft/Windows/Fonts"
    if sys.platform == "darwin":
        return home / "Library/Fonts", Path("/Library/Fonts"), Path("/System/Library/Fonts")
    return home / ".local/share/fonts", home / ".fonts", Path("/usr/local/share/fonts"), Path("/usr/share/fonts")


class FontChoice:
    """Which fonts of these folders write which texts.

    Raises:
        FlexcellError: the package that writes PDF is not installed.
    """

    def __init__(self, folders: Sequence[Path]) -> None:
        self._folders = folders
        self._metrics: Any = picture_package("reportlab.pdfbase.pdfmetrics", "what writes PDF")
        self._fonts: Any = picture_package("reportlab.pdfbase.ttfonts", "what writes PDF")
        self._known: dict[tuple[str, tuple[str, ...], bool], tuple[str, str]] = {}

    def pieces(self, text: str, families: Sequence[str], weight: float) -> list[tuple[str, str]]:
        """Return the text in pieces, each with the name of its font; a letter that no font has is a question mark.

        Raises:
            FlexcellError: there is no font at all.
        """
        pieces: list[tuple[str, str]] = []
        for letter in text:
            asked = letter, tuple(families), weight >= _LEAST_BOLD
            if asked not in self._known:
                self._known[asked] = self._written(letter, families, bold=asked[2])
            written, name = self._known[asked]
            if pieces and pieces[-1][1] == name:
                pieces[-1] = (pieces[-1][0] + written, name)
            else:
                pieces.append((written, name))
        return pieces

    def _written(self, letter: str, families: Sequence[str], *, bold: bool) -> tuple[str, str]:
        """Return a letter as it is written, and the name of the font."""
        first = ""
        for font in self._candidates(families, bold=bold):
            first = first or font.fontName
            if ord(letter) in font.face.charToGlyph:
                return letter, font.fontName
        if not first:
            raise FlexcellError(NO_FONT, hint=INSTALL_FONT)
        return "?", first

    def _candidates(self, families: Sequence[str], *, bold: bool) -> Iterator[Any]:
        """Yield fonts in the order in which they are asked for a letter: those named, then all others."""
        for family in families:
            own = _FILE_NAMES.get(family, family.lower().replace(" ", ""))
            stems = [f"{own}{ending}" for ending in (*(_BOLD if bold else ()), *_REGULAR)]
            files = (self._files[stem] for stem in stems if stem in self._files)
            yield from filter(None, map(self._opened, files))
        for file in islice(self._files.values(), _MOST_OTHERS):
            font = self._opened(file)
            if font is not None:
                yield font

    def _opened(self, file: Path) -> Any | None:
        """Return a font, the same for the same file; None where it is none that a PDF can hold."""
        name = str(file)
        if name not in self._metrics.getRegisteredFontNames():
            try:
                self._metrics.registerFont(self._fonts.TTFont(name, name))
            except (OSError, ValueError, LookupError, struct.error, self._fonts.TTFError):
                return None
        return self._metrics.getFont(name)

    @cached_property
    def _files(self) -> dict[str, Path]:
        """The font files by their names in lower case, without suffix."""
        found = (file for folder in self._folders for file in sorted(folder.rglob("*")))
        files: dict[str, Path] = {}
        for file in found:
            if file.suffix.lower() == _SUFFIX:
                files.setdefault(file.stem.lower(), file)
        return files
