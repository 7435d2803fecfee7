"""Values that JSON keeps as they are, for property tests."""

from __future__ import annotations

from hypothesis import strategies as st

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)


def json_values(
    text: st.SearchStrategy[str] = TEXT, keys: st.SearchStrategy[str] | None = None
) -> st.SearchStrategy[object]:
    """Make values with this text in them, and these keys where they are others."""
    scalars = (
        st.none() | st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False, allow_infinity=False)
    )
    return st.recursive(
        scalars | text,
        lambda inner: st.lists(inner, max_size=4) | st.dictionaries(text if keys is None else keys, inner, max_size=4),
        max_leaves=15,
    )


JSON = json_values()
