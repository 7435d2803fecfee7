"""Documents that refer to one another: who does, and how references follow a file; deleted ones come back."""

from __future__ import annotations

from itertools import count
from pathlib import Path

import pytest

from engine.editing import DocumentRepository, NoSuchDocument, text_hash
from engine.editing.references import move_with_references, referrers
from engine.errors import DocumentError
from tests.engine.editing.edit_fixtures import STATES

INNER_ID, OUTER_ID, OTHER_ID = "behaviors/parts/inner.yaml", "behaviors/outer.yaml", "behaviors/other.yaml"
INNER = """\
flexcell: 1
name: inner
outcomes: [good]
success: [good]
root:
  machine:
    initial: wait
    states:
      wait: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}
"""
OUTER = """\
flexcell: 1
name: outer
outcomes: [good]
success: [good]
root:
  machine:
    initial: one
    states:
      one: {behavior: parts/inner.yaml, transitions: {good: two}}   # the first
      two: {behavior: ./parts/inner.yaml, transitions: {good: good}}
"""


@pytest.fixture
def documents(tmp_path: Path) -> DocumentRepository:
    # Every look at the clock is a second later.
    made = DocumentRepository(tmp_path, STATES, now_s=count(1_800_000_000.0).__next__)
    (tmp_path / "behaviors/parts").mkdir(parents=True)
    for behavior_id, text in ((INNER_ID, INNER), (OUTER_ID, OUTER), (OTHER_ID, INNER.replace("inner", "inner.yaml"))):
        (tmp_path / behavior_id).write_text(text)
    return made


def test_those_that_refer_to_a_document_are_reported_with_their_nodes(documents: DocumentRepository) -> None:
    """However they write its path; a name that only occurs is no reference."""
    found = referrers(documents, INNER_ID)
    assert [(each.id, each.name, each.paths) for each in found] == [(OUTER_ID, "outer", ("root/one", "root/two"))]
    assert referrers(documents, OUTER_ID) == ()


def test_references_follow_a_document_that_moves_and_nothing_else_changes(
    documents: DocumentRepository, tmp_path: Path
) -> None:
    moved = move_with_references(documents, INNER_ID, "behaviors/more/grasp.yaml", follow=True)
    assert (moved.opened.id, moved.updated, moved.left) == ("behaviors/more/grasp.yaml", (OUTER_ID,), ())
    text = (tmp_path / OUTER_ID).read_text()
    assert text == OUTER.replace("./parts/inner.yaml", "more/grasp.yaml").replace("parts/inner.yaml", "more/grasp.yaml")
    assert documents.examine(OUTER_ID, text).findings == ()
    assert not (tmp_path / INNER_ID).exists()


def test_what_a_document_refers_to_is_found_from_its_new_folder(documents: DocumentRepository, tmp_path: Path) -> None:
    moved = move_with_references(documents, OUTER_ID, "behaviors/deep/er/outer.yaml", follow=True)
    assert "behavior: ../../parts/inner.yaml" in moved.opened.text
    assert "# the first" in moved.opened.text
    assert documents.examine(moved.opened.id, moved.opened.text).findings == ()


def test_without_following_the_references_stay(documents: DocumentRepository, tmp_path: Path) -> None:
    moved = move_with_references(documents, INNER_ID, "behaviors/parts/grasp.yaml", follow=False)
    assert (moved.updated, (tmp_path / OUTER_ID).read_text()) == ((), OUTER)


def test_a_name_that_is_taken_changes_no_file(documents: DocumentRepository, tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="there is a document"):
        move_with_references(documents, INNER_ID, OTHER_ID, follow=True)
    assert (tmp_path / OUTER_ID).read_text() == OUTER


def test_a_deleted_document_is_listed_and_comes_back_as_it_was(documents: DocumentRepository, tmp_path: Path) -> None:
    assert documents.deleted() == ()
    documents.delete(OTHER_ID)
    documents.delete(OUTER_ID)
    assert [each for each, _ in documents.deleted()] == [OUTER_ID, OTHER_ID]
    assert documents.restore(OUTER_ID).text == OUTER
    assert [each for each, _ in documents.deleted()] == [OTHER_ID]
    with pytest.raises(DocumentError, match="there is a document"):
        documents.restore(OUTER_ID)
    with pytest.raises(NoSuchDocument):
        documents.restore("behaviors/never.yaml")


def test_versions_say_who_wrote_them(documents: DocumentRepository, tmp_path: Path) -> None:
    """The editor, or another program; also when an older text comes back."""
    documents.open(INNER_ID)
    documents.save(INNER_ID, INNER + "# mine\n", base_hash=text_hash(INNER))
    (tmp_path / INNER_ID).write_text(INNER + "# theirs\n")
    assert [each.by for each in documents.versions(INNER_ID)] == ["file", "editor", "file"]
    documents.save(INNER_ID, INNER, base_hash=text_hash(INNER + "# theirs\n"))
    assert [(each.by, each.hash == text_hash(INNER)) for each in documents.versions(INNER_ID)] == [
        ("editor", True),
        ("file", False),
        ("editor", False),
    ]
    assert documents.version(INNER_ID, text_hash(INNER)) == INNER
