"""What an edit of a large document costs, and what of our documents ruamel.yaml would change without any edit.

python -m benchmarks.editing
"""

from __future__ import annotations

import io
import statistics
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import msgspec

from engine.document.loader import parse_behavior
from engine.editing import AnyEdit, Draft, ProjectContext, analyze_text, apply_edits
from engine.editing.analysis.document_graph import draw_graph
from engine.editing.text.outline import Outline
from engine.registry import load_states

ROOT = Path(__file__).parents[1]
FILE = ROOT / "behaviors" / "large.yaml"
ROUNDS = 7
SIDE = 10


def large(side: int = SIDE) -> str:
    """Return a behavior of side³ states in machines inside machines."""
    lines = ["flexcell: 1", "name: large", "outcomes: [finished]", "success: [finished]", "root:"]
    lines += _machine("  ", [f"a{i}" for i in range(side)], "finished", lambda deep, leave: _middle(deep, side, leave))
    return "\n".join(lines) + "\n"


def _machine(indent: str, names: list[str], leave: str, inside: Callable[[str, str], list[str]]) -> list[str]:
    lines = [f"{indent}machine:", f"{indent}  initial: {names[0]}", f"{indent}  states:"]
    for number, name in enumerate(names):
        follower = names[number + 1] if number + 1 < len(names) else leave
        lines += [f"{indent}    {name}:", *inside(f"{indent}      ", "done")]
        lines.append(f"{indent}      transitions: {{done: {follower}}}")
    return lines


def _middle(indent: str, side: int, leave: str) -> list[str]:
    return _machine(indent, [f"b{i}" for i in range(side)], leave, lambda deep, out: _inner(deep, side, out))


def _inner(indent: str, side: int, leave: str) -> list[str]:
    def wait(deep: str, _: str) -> list[str]:
        return [f"{deep}state: flow.Wait  # waits", f"{deep}with: {{duration_s: 0.5}}"]

    return _machine(indent, [f"c{i}" for i in range(side)], leave, wait)


def milliseconds(work: Callable[[], object]) -> float:
    """Return the median CPU time of a piece of work."""
    times: list[float] = []
    for _ in range(ROUNDS):
        start = time.process_time()
        work()
        times.append((time.process_time() - start) * 1e3)
    return statistics.median(times)


def _draw(text: str, context: ProjectContext) -> object:
    draft = Draft(text, file="x.yaml")
    return draw_graph(draft, context, Outline(draft.data))


def kept_by_ruamel(text: str) -> bool:
    """Return whether ruamel.yaml, set to keep quotes and never to break lines, writes a text back as it was."""
    # ruamel.yaml is partly untyped: Any contains it here.
    yaml: Any = import_module("ruamel.yaml").YAML()
    yaml.preserve_quotes = True
    yaml.width = 100_000
    yaml.indent(mapping=2, sequence=4, offset=2)
    written = io.StringIO()
    yaml.dump(yaml.load(text), written)
    return written.getvalue() == text


def main() -> None:
    """Print both tables."""
    text = large()
    context = ProjectContext(load_states(), FILE.parent, ROOT)
    deep = "root/a5/b5"
    edits: dict[str, list[dict[str, Any]]] = {
        "set_parameter": [{"edit": "set_parameter", "path": f"{deep}/c5", "name": "duration_s", "value": 1}],
        "rename_node": [{"edit": "rename_node", "path": f"{deep}/c5", "name": "other"}],
        "add_node into an arrow": [
            {
                "edit": "add_node",
                "parent": deep,
                "kind": "state",
                "runs": "flow.Wait",
                "parameters": {"duration_s": 1},
                "on_edge": {"from": f"{deep}/c5", "outcome": "done"},
            }
        ],
        "group three": [{"edit": "group", "paths": [f"{deep}/c{i}" for i in (3, 4, 5)], "kind": "machine"}],
        "set_positions of all": [
            {
                "edit": "set_positions",
                "positions": {path: [1, 2] for path, _ in parse_behavior(text, file=FILE).nodes()},
            }
        ],
    }
    print(f"{SIDE**3} states, {len(text) / 1e3:.0f} kB")
    drawn = milliseconds(lambda: _draw(text, context))
    checked = milliseconds(lambda: analyze_text(text, file=FILE, context=context))
    print(f"  {'draw':23} {drawn:7.1f} ms")
    print(f"  {'draw and check':23} {checked:7.1f} ms")
    for name, raw in edits.items():
        made = msgspec.convert(raw, list[AnyEdit])
        spent = milliseconds(lambda made=made: apply_edits(text, made, file="x.yaml", context=context))
        print(f"  {name:23} {spent:7.1f} ms")
    files = sorted((ROOT / "behaviors").rglob("*.yaml"))
    texts = [file.read_text(encoding="utf-8") for file in files]
    ours = sum(Draft(each, file="x.yaml").text() == each for each in texts)
    print(
        f"the same bytes without an edit: ours {ours}, ruamel.yaml {sum(map(kept_by_ruamel, texts))}, of {len(files)}"
    )


if __name__ == "__main__":
    main()
