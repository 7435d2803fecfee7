"""Trigger documents: actions of buttons, with the keys of the Helping Hand's configuration (RCY figure 12).

    flexcell: 1
    triggers:
      - trig_name: Record joint state
        robot_ns: left
        trig_topic: /keypress/previous
        trig_type: rising_edge
        trig_value: true
        trig_callback: joint_save

A leading `/` of topics and namespaces is ignored; the default namespace is that of the only robot. A file
that contains only the list is accepted.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.yaml_source import DataPath, DocumentSource, load_source, parse_source
from engine.errors import DocumentError
from engine.skills.teaching import Trigger


class TeachDocument(StrictModel, frozen=True, kw_only=True):
    """Triggers as written; their names are unique."""

    flexcell: Literal[1]
    triggers: list[Trigger]


def load_triggers(path: Path | str) -> tuple[Trigger, ...]:
    """Read a trigger document.

    Raises:
        DocumentError: the file cannot be read, is no trigger document, or uses a name twice; `where` is the position.
    """
    return _triggers(load_source(Path(path)))


def parse_triggers(text: str, *, file: str) -> tuple[Trigger, ...]:
    """Read the text of a trigger document; `file` is its name in positions.

    Raises:
        DocumentError: the text is not a trigger document, or uses a name twice; `where` is the position.
    """
    return _triggers(parse_source(text, file=file))


def _triggers(source: DocumentSource) -> tuple[Trigger, ...]:
    bare = isinstance(source.data, list)
    triggers = decode_document(source, list[Trigger]) if bare else decode_document(source, TeachDocument).triggers
    seen: set[str] = set()
    for index, trigger in enumerate(triggers):
        if trigger.trig_name in seen:
            at: DataPath = (index, "trig_name") if bare else ("triggers", index, "trig_name")
            raise DocumentError(
                f"two triggers have the name {trigger.trig_name!r}",
                where=source.position(at),
                hint="give each its own name",
            )
        seen.add(trigger.trig_name)
    return tuple(triggers)
