"""Templates of new behaviors."""

from __future__ import annotations

from collections.abc import Mapping

from engine.editing.text.yaml_style import scalar_text
from engine.errors import DocumentError
from engine.wording.suggestions import did_you_mean

_HEAD = "flexcell: 1\nname: {name}\n{cell}outcomes: [finished, failed]\nsuccess: [finished]\nroot:\n"
_TREE_HEAD = "flexcell: 1\nname: {name}\n{cell}outcomes: [success, failure]\nsuccess: [success]\nroot:\n"
TEMPLATES: Mapping[str, str] = {
    "machine": _HEAD + "  machine:\n    states: {{}}\n",
    "sequence": _TREE_HEAD + "  tree:\n    sequence: []\n",
    "concurrency": _HEAD + "  concurrency:\n    states: {{}}\n    conditions: []\n",
}


def new_text(template: str, *, name: str, cell: str | None = None) -> str:
    """Return the text of a new behavior without nodes.

    Args:
        template: The name of the template.
        name: That of the behavior.
        cell: The path of its cell, relative to its file; None for a behavior of any cell.

    Raises:
        DocumentError: there is no such template.
    """
    if template not in TEMPLATES:
        raise DocumentError(f"there is no template `{template}`", hint=did_you_mean(template, TEMPLATES))
    line = f"cell: {scalar_text(cell, json=False, flow=False)}\n" if cell is not None else ""
    return TEMPLATES[template].format(name=scalar_text(name, json=False, flow=False), cell=line)
