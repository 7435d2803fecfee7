"""YAML file of the triggers of the Helping Hand; manual formatting and comments are preserved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import msgspec

from engine.document.text.yaml_source import parse_source
from engine.editing.text.yaml_style import scalar_text
from engine.errors import DocumentError, StoreError
from engine.host.private_files import make_private_folder, open_private
from engine.skills.teaching import Trigger
from engine.teaching.teach_document import parse_triggers

UNNAMED = "triggers.yaml"
_HEAD = "flexcell: 1\ntriggers:"
_ALWAYS = ("trig_name", "robot_ns", "trig_topic", "trig_type", "trig_value", "trig_callback")


class TriggerFile:
    """The text of a trigger document, in a file or, with `path` None, in memory only.

    Args:
        path: The file; it is created with the first change.
        triggers: The triggers if there is no file.
    """

    def __init__(self, path: Path | None, triggers: Sequence[Trigger] = ()) -> None:
        self._path = path
        self.text = rewrite_triggers("", tuple(triggers))

    @property
    def name(self) -> str:
        """The file's path; empty if there is none."""
        return str(self._path) if self._path is not None else ""

    def load(self) -> tuple[Trigger, ...]:
        """Return the triggers currently in the file.

        Raises:
            DocumentError: the file cannot be read, or is not a trigger document; `where` is the position.
        """
        if self._path is not None and self._path.exists():
            try:
                self.text = self._path.read_text(encoding="utf-8")
            except (OSError, UnicodeDecodeError) as error:
                raise DocumentError(f"cannot read the triggers: {error}", where=self._path) from error
        return parse_triggers(self.text, file=self.name or UNNAMED)

    def write(self, triggers: Sequence[Trigger]) -> tuple[Trigger, ...]:
        """Replace the triggers and return them; an unchanged trigger keeps its lines.

        Raises:
            StoreError: the file cannot be written; nothing is changed.
        """
        return self.write_text(rewrite_triggers(self.text, tuple(triggers)))

    def write_text(self, text: str) -> tuple[Trigger, ...]:
        """Write a whole document and return its triggers.

        Raises:
            DocumentError: the text is not a trigger document; `where` is the position. Nothing is changed.
            StoreError: the file cannot be written; nothing is changed.
        """
        triggers = parse_triggers(text, file=self.name or UNNAMED)
        if self._path is not None:
            part = self._path.with_suffix(".part")
            try:
                make_private_folder(self._path.parent)
                with open_private(part) as stream:
                    stream.write(text.encode())
                part.replace(self._path)
            except OSError as error:
                raise StoreError(
                    f"the triggers cannot be written: {error.strerror or error}", where=self.name
                ) from error
        self.text = text
        return triggers


def rewrite_triggers(text: str, triggers: tuple[Trigger, ...]) -> str:
    """Return `text` with these triggers: existing ones keep their lines, with the comments above them."""
    head, known = _blocks(text)
    if not triggers:
        return f"{_HEAD} []\n"
    blocks = [known.get(_key(trigger)) or _block(trigger) for trigger in triggers]
    return "\n".join((head, *blocks)) + "\n"


def _key(trigger: Trigger) -> bytes:
    # True == 1 in Python, but not as a button value.
    return msgspec.json.encode(trigger)


def _blocks(text: str) -> tuple[str, dict[bytes, str]]:
    """Return the lines before the first trigger, and the lines of each; no blocks if triggers share lines."""
    try:
        triggers = parse_triggers(text, file=UNNAMED)
        place = parse_source(text, file=UNNAMED).place
    except DocumentError:
        return _HEAD, {}
    children = place.children or {}
    items = children["triggers"].children if "triggers" in children else None
    starts = [item.line for item in (items or {}).values()]
    # A bare list, or one on a single line, is rewritten.
    if not starts or len(set(starts)) < len(starts) or starts[0] <= children["triggers"].key_line:
        return _HEAD, {}
    lines = text.rstrip("\n").split("\n")
    begins = [_with_comments(lines, start) for start in starts]
    ends = [*begins[1:], len(lines)]
    indent = len(lines[starts[0]]) - len(lines[starts[0]].lstrip())
    if indent != len(_INDENT):
        return _HEAD, {}
    blocks = ("\n".join(lines[begin:end]).rstrip() for begin, end in zip(begins, ends, strict=True))
    return "\n".join(lines[: begins[0]]), dict(zip(map(_key, triggers), blocks, strict=True))


_INDENT = "  "


def _with_comments(lines: list[str], start: int) -> int:
    while start > 0 and lines[start - 1].lstrip().startswith("#"):
        start -= 1
    return start


def _block(trigger: Trigger) -> str:
    fields = msgspec.structs.asdict(trigger)
    defaults = {field.name: field.default for field in msgspec.structs.fields(Trigger)}
    shown = [name for name, value in fields.items() if name in _ALWAYS or value != defaults[name]]
    ordered = sorted(shown, key=lambda name: _ALWAYS.index(name) if name in _ALWAYS else len(_ALWAYS))
    # JSON's scalars are YAML's, and quoted text means the same to every reader.
    lines = [f"{name}: {scalar_text(fields[name], json=True, flow=True)}" for name in ordered]
    return "\n".join(f"{_INDENT}{'- ' if at == 0 else '  '}{line}" for at, line in enumerate(lines))
