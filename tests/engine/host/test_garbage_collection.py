"""The collector is set once, for the whole process; it works on, also while documents are read on threads."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PROGRAM = """
import gc, sys
from pathlib import Path
from engine.host.garbage_collection import freeze_loaded_objects, set_up_collector
set_up_collector()
freeze_loaded_objects()
from benchmarks.large_document import large_document
from engine.editing import ProjectContext
from engine.editing.draft_cache import DraftCache
from engine.registry import load_states
full = []
gc.callbacks.append(lambda phase, info: full.append(info) if (phase, info["generation"]) == ("stop", 2) else None)
context = ProjectContext(load_states(), Path("."), Path("."))
DraftCache().draw(large_document(3000), file=Path("x.yaml").absolute(), context=context, check=True)
print(len(full), gc.isenabled())
"""


def test_a_large_document_is_read_and_checked_without_a_full_collection() -> None:
    command = [sys.executable, "-P", "-c", PROGRAM]
    done = subprocess.run(command, cwd=ROOT, env={"PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=True)
    assert done.stdout == "0 True\n"


@pytest.mark.parametrize("package", ["engine", "editor_web", "states"])
def test_only_the_start_of_a_process_switches_it(package: str) -> None:
    """A thread that switched it would do so for the threads that move arms."""
    found = {
        str(file.relative_to(ROOT))
        for file in (ROOT / package).rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "gc"
        and node.attr in ("disable", "enable", "set_threshold")
    }
    starts = {"engine/cli/entry.py", "engine/host/garbage_collection.py"}
    assert found == (starts if package == "engine" else set())
