"""What is recorded of a behavior made in Python is that behavior, not a document lying where its own would be."""

from __future__ import annotations

from pathlib import Path

from engine.authoring import behavior, reference, state, write_behavior
from engine.document import Behavior, load_behavior
from engine.recording import collect_documents
from tests.engine.fake_states import Give


def _made(folder: Path, outcome: str) -> Behavior:
    inner = behavior("inner", outcomes=["a"], root=state(Give(outcome=outcome)), file=str(folder / "inner.yaml"))
    return behavior("outer", outcomes=["a"], root=reference(inner), file=str(folder / "outer.yaml"))


def test_documents_of_an_earlier_export_are_not_taken_for_the_behavior(tmp_path: Path) -> None:
    """Both the behavior and the one it refers to have changed since."""
    write_behavior(_made(tmp_path, "a"), tmp_path / "outer.yaml")
    made = _made(tmp_path, "b")
    unpacked = collect_documents(made).unpack(tmp_path / "unpacked")
    assert load_behavior(unpacked).meaning == made.meaning
