"""The writer: what it writes is read back as it was."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from engine.document import parse_source, write_yaml
from tests.engine.document.example_documents import VALUES


@given(st.dictionaries(st.sampled_from(["a", "on", "1e3", "null", "x y"]), VALUES))
def test_data_written_is_read_back_with_the_same_types(data: dict[str, object]) -> None:
    """Text that looks like a number, a word or a date stays text."""
    text = write_yaml(data)
    assert repr(parse_source(text, file="x.yaml").data) == repr(data)
    assert write_yaml(parse_source(text, file="x.yaml").data) == text


def test_a_shared_value_is_written_out() -> None:
    """No anchors, which the reader refuses."""
    shared = [1, 2]
    assert write_yaml({"a": shared, "b": shared}) == "a: [1, 2]\nb: [1, 2]\n"
