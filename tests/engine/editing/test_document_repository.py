"""Documents on disk: whole files, versions that are kept, comparison, data flow."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from engine.editing import DocumentConflict, DocumentRepository, NoSuchDocument, text_hash
from engine.editing.analysis.document_diff import compare_texts
from engine.editing.versions import MAX_VERSIONS
from engine.errors import DocumentError
from tests.engine.editing.edit_fixtures import STATES, edited
from tests.engine.editing.edits.test_node_edits import TEXT

ID = "behaviors/a/x.yaml"


class Clock:
    """A wall clock that goes on by a second whenever it is read."""

    def __init__(self) -> None:
        self.now_s = 1_000_000.0

    def __call__(self) -> float:
        self.now_s += 1.0
        return self.now_s


@pytest.fixture
def documents(tmp_path: Path) -> DocumentRepository:
    made = DocumentRepository(tmp_path, STATES, now_s=Clock())
    made.create(ID)
    (tmp_path / ID).write_text(TEXT)
    return made


def test_a_file_keeps_its_mode_and_leaves_nothing_behind(documents: DocumentRepository) -> None:
    file = documents.file_of(ID)
    file.chmod(0o640)
    documents.save(ID, TEXT + "# more\n", base_hash=text_hash(TEXT))
    assert file.stat().st_mode & 0o777 == 0o640
    assert [each.name for each in file.parent.iterdir()] == ["x.yaml"]


def test_a_project_that_cannot_be_written_is_read_and_says_so_when_it_is_saved(tmp_path: Path) -> None:
    """A file stands where the versions would be kept, which stops root too."""
    (tmp_path / ID).parent.mkdir(parents=True)
    (tmp_path / ID).write_text(TEXT)
    (tmp_path / ".flexcell").write_text("")
    documents = DocumentRepository(tmp_path, STATES)
    assert documents.open(ID).text == TEXT
    refused = rf"{ID}: the document cannot be written: .*grant this server write permission"
    with pytest.raises(DocumentError, match=refused):
        documents.save(ID, TEXT + "# more\n", base_hash=text_hash(TEXT))
    with pytest.raises(DocumentError, match=refused):
        documents.rename(ID, "behaviors/a/y.yaml")
    with pytest.raises(DocumentError, match=refused):
        documents.delete(ID)
    assert (tmp_path / ID).read_text() == TEXT


def test_a_folder_that_cannot_be_written_is_reported(documents: DocumentRepository) -> None:
    """The file stays as it was."""
    file = documents.file_of(ID)
    (file.parent / f".{file.name}.new").mkdir()
    with pytest.raises(DocumentError, match="the document cannot be written"):
        documents.save(ID, TEXT + "# more\n", base_hash=text_hash(TEXT))
    assert file.read_text() == TEXT


def test_a_version_that_comes_again_is_kept_once(documents: DocumentRepository) -> None:
    first = documents.open(ID)
    documents.save(ID, TEXT + "# more\n", base_hash=first.hash)
    documents.save(ID, TEXT, base_hash=text_hash(TEXT + "# more\n"))
    found = [each.hash for each in documents.versions(ID)]
    assert found[:2] == [first.hash, text_hash(TEXT + "# more\n")]
    assert len(set(found)) == len(found)
    assert documents.version(ID, first.hash) == TEXT


def test_so_many_versions_are_kept_and_no_more(documents: DocumentRepository) -> None:
    base = documents.open(ID).hash
    for number in range(MAX_VERSIONS + 5):
        base = documents.save(ID, f"{TEXT}# {number}\n", base_hash=base).hash
    assert len(documents.versions(ID)) == MAX_VERSIONS
    with pytest.raises(DocumentError, match="not kept"):
        documents.version(ID, text_hash(TEXT))


def test_saving_the_text_that_is_there_is_no_conflict(documents: DocumentRepository) -> None:
    assert documents.save(ID, TEXT, base_hash="0" * 64).hash == text_hash(TEXT)


def test_what_both_add_is_a_conflict_where_its_lines_could_be_merged(documents: DocumentRepository) -> None:
    """Either change is well, the lines together would repeat a key."""
    base = "flexcell: 1\n\n\n\nname: x\n"
    documents.create("behaviors/y.yaml")
    file = documents.file_of("behaviors/y.yaml")
    file.write_text(base)
    opened = documents.open("behaviors/y.yaml")
    file.write_text(f"description: a\n{base}")
    with pytest.raises(DocumentConflict) as raised:
        documents.save("behaviors/y.yaml", f"{base}description: b\n", base_hash=opened.hash)
    merge = raised.value.merge
    assert merge is not None
    assert [(each.path, each.field, each.mine, each.theirs) for each in merge.conflicts] == [
        ("document", "description", "b", "a")
    ]


def test_a_deleted_document_can_be_brought_back(documents: DocumentRepository) -> None:
    documents.open(ID)
    documents.delete(ID)
    with pytest.raises(NoSuchDocument):
        documents.open(ID)
    newest = documents.versions(ID)[0]
    assert documents.version(ID, newest.hash) == TEXT


def test_a_new_json_document_is_json(documents: DocumentRepository) -> None:
    made = documents.create("behaviors/new.json", template="sequence", name="été")
    assert json.loads(made.text)["name"] == "été"
    text = edited(
        made.text,
        {"edit": "add_node", "parent": "root/sequence", "kind": "state", "runs": "test.Give"},
        {"edit": "set_field", "path": "root/sequence/Give", "field": "description", "value": "𝄞 \n"},
        {"edit": "set_field", "path": "root/sequence/Give", "field": "notes", "value": "x"},
        file="new.json",
    )
    assert json.loads(text)["root"]["tree"]["sequence"] == [{"description": "𝄞 \n", "state": "test.Give"}]


def test_json_with_escapes_of_two_halves_is_edited_in_place() -> None:
    text = '{"name": "\\ud834\\udd1e", "flexcell": 1, "x": ["\\ud834\\udd1e\\ud834\\udd1e", 1], "root": {"state": "a"}}'
    made = edited(text, {"edit": "set_field", "path": "root", "field": "state", "value": "b"}, file="x.json")
    assert made == text.replace('"a"', '"b"')


def test_yaml_is_not_renamed_to_json(documents: DocumentRepository) -> None:
    with pytest.raises(DocumentError, match="keep"):
        documents.rename(ID, "behaviors/x.json")


def test_versions_are_compared_node_by_node() -> None:
    after = edited(
        TEXT,
        {"edit": "rename_node", "path": "root/third", "name": "last"},
        {"edit": "set_parameter", "path": "root/both/left", "name": "after_s", "value": 2},
        {"edit": "add_node", "parent": "root", "kind": "state", "runs": "flow.Wait"},
        {"edit": "set_document", "changes": {"description": "New."}},
    )
    found = compare_texts(TEXT, after, file="x.yaml")
    assert [(each.path, each.change, each.before_path) for each in found.changes] == [
        ("document", "changed", None),
        ("root", "changed", None),
        ("root/first", "changed", None),
        ("root/both", "changed", None),
        ("root/both/left", "changed", None),
        ("root/last", "moved", "root/third"),
        ("root/wait", "added", None),
    ]
    left = found.changes[4].fields
    assert [(each.field, each.before, each.after) for each in left] == [("with.after_s", 0.01, 2)]
    gone = compare_texts(after, TEXT, file="x.yaml")
    assert ("root/wait", "removed") in [(each.path, each.change) for each in gone.changes]


def test_moved_boxes_are_distinguished_from_changes_of_meaning() -> None:
    after = edited(TEXT, {"edit": "set_positions", "positions": {"root/third": [1, 2]}})
    assert compare_texts(TEXT, after, file="x.yaml").layout_only
    assert not compare_texts(TEXT, TEXT, file="x.yaml").layout_only
    assert compare_texts(TEXT, TEXT, file="x.yaml").changes == ()


def test_the_data_flow_says_who_writes_and_who_reads(documents: DocumentRepository) -> None:
    text = """\
flexcell: 1
name: flow
parameters: {speed: {type: number, default: 1}}
userdata: {count: 0}
outcomes: [done]
root:
  machine:
    initial: decide
    states:
      decide: {state: flow.Decide, with: {when: "${count > speed}"}, transitions: {"true": write, "false": read}}
      write: {state: flow.SetValue, with: {value: "${count}"}, out: {value: key}, transitions: {done: read}}
      read: {state: flow.SetValue, with: {value: "${key}"}, out: {value: count}, transitions: {done: done}}
"""
    flow = {each.key: each for each in documents.data_flow(ID, text)}
    assert list(flow) == ["speed", "count", "key"]
    assert [(each.path, each.origin) for each in flow["count"].writers] == [("", "userdata"), ("root/read", "output")]
    (reader,) = flow["key"].readers
    assert (reader.path, reader.defined, reader.sources) == ("root/read", "maybe", ("root/write",))
    assert reader.witness == "decide → read"
    assert {each.path: each.defined for each in flow["count"].readers} == {
        "root/decide": "always",
        "root/write": "always",
    }


def test_the_data_flow_reads_nothing_outside_of_the_project(documents: DocumentRepository) -> None:
    text = TEXT.replace("third: {state: test.Give,", "third: {behavior: ../../../../etc/passwd,")
    with pytest.raises(DocumentError, match="leads out of the project"):
        documents.data_flow(ID, text)
