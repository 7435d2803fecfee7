"""Every example of the how-to is a file that runs, makes behaviors without findings, and passes the type checker."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import pytest

from engine.authoring import load_python_behavior, to_yaml
from engine.bus import SkillBus
from engine.check import check_behavior
from engine.clock import new_clock, run_virtual
from engine.document import Behavior, parse_behavior
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "how-to" / "write-behaviors-in-python.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)
MADE: list[tuple[str, int, dict[str, object]]] = [
    ("transfer", 0, {}),
    ("count", 2, {"pause": 1.5}),
    ("search", 3, {}),
    ("work", 4, {}),
    ("rest", 5, {}),
]
"""What the examples make, in which of them, and with which parameters they run."""
WRONG = """
    from engine.authoring import concurrency, machine, parameter, sequence, state
    from states.flow.wait import Wait

    name = parameter("name", str)
    wrong_value = state(Wait(duration_s=name.value))
    wrong_field = state(Wait(duration=1.0))
    wrong_key = state(Wait(duration_s=1.0), transition={"done": "x"})
    wrong_level = state(Wait(duration_s=1.0), autonomy={"done": "higher"})
    wrong_machine = machine(states={})
    wrong_child = machine(initial="s", states={"s": sequence(state(Wait(duration_s=1.0)))})
    wrong_rules = concurrency(states={}, conditions=[{"done": {"a": "b"}}])
    wrong_default = parameter("n", float, default="fast")
"""


def _files(folder: Path) -> list[Path]:
    """Write the examples as modules whose names no other test uses."""
    files = [folder / f"how_to_{folder.name.replace('-', '_')}_{index}.py" for index in range(len(EXAMPLES))]
    for file, text in zip(files, EXAMPLES, strict=True):
        file.write_text(text, encoding="utf-8")
    return files


def test_the_examples_are_all_known() -> None:
    """A new one is added to `MADE` when it makes a behavior."""
    with_behavior = [index for index, text in enumerate(EXAMPLES) if "= behavior(" in text]
    assert with_behavior == [index for _, index, _ in MADE]


@pytest.mark.parametrize("index", range(len(EXAMPLES)))
def test_an_example_runs_as_it_is(tmp_path: Path, index: int) -> None:
    """In a process of its own, in an empty folder."""
    file = _files(tmp_path)[index]
    done = subprocess.run(
        [sys.executable, file], cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    ("name", "index", "parameters"), MADE, ids=lambda value: value if isinstance(value, str) else ""
)
def test_the_behavior_of_an_example_has_no_findings_and_reads_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, index: int, parameters: dict[str, object]
) -> None:
    """Those that need no robot are run to a nominal end."""
    monkeypatch.chdir(tmp_path)
    made = load_python_behavior(f"{_files(tmp_path)[index]}:{name}")
    catalogue = load_states()
    for path, target in made.references.items():
        (tmp_path / path).write_text(to_yaml(target), encoding="utf-8")
    assert parse_behavior(to_yaml(made), file=tmp_path / "x.yaml").meaning == made.meaning
    assert [str(finding) for finding in check_behavior(made, catalogue)] == []
    if name != "transfer":
        result = run_virtual(_run(made, parameters))
        assert (result.status, result.outcome) == ("finished", made.outcomes[0]), result.cause


async def _run(made: Behavior, parameters: dict[str, object]) -> RunResult:
    plan = new_plan(made, load_states())
    return await Run(plan, run="r", bus=SkillBus(new_clock()), parameters=parameters).execute()


def test_the_type_checker_passes_the_examples_and_marks_each_wrong_line(tmp_path: Path) -> None:
    """pyright in strict mode."""
    files = _files(tmp_path)
    wrong = tmp_path / "wrong.py"
    wrong.write_text(dedent(WRONG), encoding="utf-8")
    settings = {"typeCheckingMode": "strict", "extraPaths": [str(ROOT)], "pythonVersion": "3.11"}
    (tmp_path / "pyrightconfig.json").write_text(str(settings).replace("'", '"'), encoding="utf-8")
    pyright = Path(sys.executable).with_name("pyright")
    command = [pyright, "--pythonpath", sys.executable, "--project", tmp_path]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False)
    marked = {
        (Path(file).name, int(line)) for file, line in re.findall(r"(?m)^\s*(\S+\.py):(\d+):\d+ - error", done.stdout)
    }
    assert [row for row in marked if row[0] in {file.name for file in files}] == [], done.stdout
    lines = dedent(WRONG).splitlines()
    wrong_lines = {index for index, line in enumerate(lines, 1) if line.startswith("wrong_")}
    assert {line for _, line in marked} == wrong_lines, done.stdout
