"""The file of an equipment server: replaced as a whole, the old one kept with its time, never by two at once."""

from __future__ import annotations

import hashlib
import os
import re
from datetime import UTC, datetime
from pathlib import Path

from engine.document.equipment import Equipment, read_equipment
from engine.errors import RobotError

_KEPT = re.compile(r"(\d{8}T\d{6}\.\d{6}Z)\.yaml")


class ConfigurationFile:
    """One equipment document on disk; earlier ones are in the folder `.NAME.kept` beside it."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self._folder = file.with_name(f".{file.name}.kept")

    def load(self) -> Equipment:
        """Read the document; raises DocumentError."""
        return read_equipment(self.text(), file=self.file)

    def text(self) -> str:
        """Return the text of the file; raises RobotError where it cannot be read."""
        try:
            return self.file.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise RobotError(f"cannot read the configuration: {error}", where=str(self.file)) from error

    def digest(self) -> str:
        """Return what tells this text from others."""
        return text_digest(self.text())

    def kept(self) -> tuple[str, ...]:
        """Return at which times (UTC) earlier texts were replaced, the latest last."""
        names = sorted(path.name for path in self._folder.iterdir()) if self._folder.is_dir() else []
        return tuple(found[1] for found in map(_KEPT.fullmatch, names) if found)

    def replace(self, text: str, *, base: str) -> None:
        """Replace the text with the digest `base`, and keep it.

        Raises:
            RobotError: the file has another text by now, or the disk refuses; the file is as before.
        """
        self.require_base(base)
        try:
            self._folder.mkdir(exist_ok=True)
            stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S.%fZ")
            _write(self._folder / f"{stamp}.yaml", self.text())
            _write(self.file, text)
        except OSError as error:
            raise RobotError(f"the configuration was not written: {error}", where=str(self.file)) from error

    def require_base(self, base: str) -> None:
        """Refuse a change of another text than that in the file; raises RobotError."""
        if base != self.digest():
            hint = "read the configuration again, and make your change in that one"
            raise RobotError("the configuration was changed since you have read it", where=str(self.file), hint=hint)

    def previous(self) -> str:
        """Return the text that was replaced last; raises RobotError without any."""
        kept = self.kept()
        if not kept:
            raise RobotError("there is no earlier configuration", where=str(self.file))
        return (self._folder / f"{kept[-1]}.yaml").read_text(encoding="utf-8")

    def take_back(self, *, base: str) -> None:
        """Put the text that was replaced last into the file; raises as `replace`."""
        self.require_base(base)
        text, stamp = self.previous(), self.kept()[-1]
        try:
            _write(self.file, text)
            (self._folder / f"{stamp}.yaml").unlink()
        except OSError as error:
            raise RobotError(f"the configuration was not taken back: {error}", where=str(self.file)) from error


def text_digest(text: str) -> str:
    """Return the SHA-256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()


def _write(file: Path, text: str) -> None:
    """Replace a file so that it is whole after a power failure too: with its entry in the folder."""
    fresh = file.with_name(f".{file.name}.new")
    try:
        with fresh.open("wb") as stream:
            stream.write(text.encode())
            stream.flush()
            os.fsync(stream.fileno())
        fresh.replace(file)
    except OSError:
        fresh.unlink(missing_ok=True)
        raise
    folder = os.open(file.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)
