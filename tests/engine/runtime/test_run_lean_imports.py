"""What loading, planning and running a behavior imports: no library that only some behaviors need."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
RUN = """
import asyncio, json, sys
from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.state import Outcome, State

class Nod(State, frozen=True, kw_only=True):
    state_name = "own.Nod"
    outcomes = ("success",)
    async def run(self, ctx):
        return Outcome("success")

HEAD = "flexcell: 1\\nname: b\\noutcomes: [success]\\nsuccess: [success]\\nroot: {machine: {initial: a, states: {a: {"
TAIL = "}}}}\\n"

def ended(work):
    async def main():
        plan = new_plan(parse_behavior(HEAD + work + TAIL, file="b.yaml"), {"own.Nod": Nod})
        return (await Run(plan, run="r", bus=SkillBus(new_clock())).execute()).outcome
    return run_virtual(main())

SPARED = {"py_trees", "importlib.metadata", "difflib", "cel_expr_python"}
SPARED |= {"engine.document.entries_document", "engine.runtime.history.step_back", "engine.runtime.step_back_executor"}
told = []
for work in (
    "state: own.Nod, transitions: {success: success}",
    "tree: {sequence: [{state: own.Nod}]}, transitions: {success: success, failure: success}",
):
    told.append([ended(work), sorted(SPARED & set(sys.modules))])
print(json.dumps(told))
"""


def test_py_trees_is_loaded_with_the_first_tree_and_what_few_runs_need_not_at_all() -> None:
    """That is what reads packages and entries, evaluates formulas, compares mistyped names and takes a run back."""
    command = [sys.executable, "-P", "-c", RUN]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == [["success", []], ["success", ["py_trees"]]]
