"""Types are ready before a second thread can see them: all of ours, and those that others define."""

from __future__ import annotations

import gc
import importlib
import pkgutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

import msgspec
import pytest

from engine.document.signature import read_signature
from engine.state import Context, Outcome, State
from engine.type_preparation import prepare_on_import, prepare_type, prepare_types

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")
FIRST_THING = """
import sys, threading
sys.setswitchinterval(1e-6)
{imports}
gate = threading.Barrier(4)
def work():
    gate.wait()
    {call}
threads = [threading.Thread(target=work) for _ in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
"""
MODULE = """
from __future__ import annotations
import msgspec
class Tree(msgspec.Struct):
    branches: list[Branch]
    class Leaf(msgspec.Struct):
        number: int
class Branch(msgspec.Struct):
    tree: Tree | None
"""


def is_ready(kind: type[msgspec.Struct]) -> bool:
    """Whether msgspec has its record of a type; it names it nowhere but to the garbage collector."""
    return any(type(each).__name__ == "StructInfo" for each in gc.get_referents(kind))


def is_refused(kind: type[msgspec.Struct]) -> bool:
    """Whether msgspec never decodes a type, as it has a field of two classes of ours; then it keeps no record of it."""
    try:
        msgspec.json.Decoder(kind)
    except TypeError:
        return True
    return False


def structs(kind: type[msgspec.Struct] = msgspec.Struct) -> Iterator[type[msgspec.Struct]]:
    for each in kind.__subclasses__():
        yield each
        yield from structs(each)


def test_every_type_of_ours_is_ready_once_its_module_is_imported() -> None:
    """Nobody has to list a new one."""
    for package in PACKAGES:
        home = importlib.import_module(package).__path__
        for module in pkgutil.walk_packages(home, f"{package}."):
            importlib.import_module(module.name)
    ours = {kind for kind in structs() if kind.__module__.partition(".")[0] in PACKAGES}
    assert len(ours) > 400
    assert [kind for kind in ours if not is_ready(kind) and not is_refused(kind)] == []


@pytest.mark.parametrize(
    ("imports", "call"),
    [
        (
            "from engine.document import load_behavior",
            "load_behavior('behaviors/reconcycle/two_arm_transfer.yaml')",
        ),
        ("from engine.document.cell import load_cell", "load_cell('behaviors/cells/dual_panda.yaml')"),
        (
            "from engine.document.entries_document import load_entries",
            "load_entries('behaviors/entries/dual_panda.yaml')",
        ),
        (
            "import msgspec; from engine.event import AnyEvent",
            "msgspec.json.Decoder(AnyEvent)",
        ),
    ],
)
def test_four_threads_may_read_the_first_document_at_once(imports: str, call: str) -> None:
    """Which ended by SIGSEGV, for certain where threads change places every microsecond."""
    program = FIRST_THING.format(imports=imports, call=call)
    ended = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_types_that_name_later_ones_are_ready_after_the_import(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those inside of classes too."""
    (tmp_path / "grown_trees.py").write_text(MODULE, encoding="utf-8")
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    prepare_on_import("grown_trees")
    grown = importlib.import_module("grown_trees")
    assert [is_ready(kind) for kind in (grown.Tree, grown.Branch, grown.Tree.Leaf)] == [True, True, True]


def test_types_of_modules_that_import_one_another_are_ready_when_both_are_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "egg_types.py").write_text(
        "from __future__ import annotations\nimport msgspec\nimport hen_types\n"
        "class Egg(msgspec.Struct):\n    hen: hen_types.Hen | None\n",
        encoding="utf-8",
    )
    (tmp_path / "hen_types.py").write_text(
        "from __future__ import annotations\nimport msgspec\nimport egg_types\n"
        "class Hen(msgspec.Struct):\n    eggs: list[egg_types.Egg]\n",
        encoding="utf-8",
    )
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    prepare_on_import("egg_types", "hen_types")
    egg, hen = importlib.import_module("egg_types").Egg, importlib.import_module("hen_types").Hen
    assert (is_ready(egg), is_ready(hen)) == (True, True)


def test_a_state_that_was_defined_anywhere_is_ready_once_it_is_described() -> None:
    class Nod(State, frozen=True, kw_only=True):
        """Nod."""

        outcomes: ClassVar[tuple[str, ...]] = ("nodded",)

        async def run(self, ctx: Context) -> Outcome:
            return Outcome("nodded")

    read_signature(Nod)
    assert is_ready(Nod)


def test_all_types_of_a_process_can_be_made_ready() -> None:
    class Message(msgspec.Struct):
        text: str

    assert not is_ready(Message)
    prepare_types()
    assert is_ready(Message)


def test_a_type_that_cannot_be_decoded_says_so_to_whoever_tries() -> None:
    class Odd(msgspec.Struct):
        both: bytes | str | complex | Path

    prepare_type(Odd)
    with pytest.raises(TypeError, match="custom type"):
        msgspec.convert({}, Odd)
