"""A text under edit: its mutable plain data, and the conversion back to text."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from typing import cast

from engine.editing.text.node_matching import is_equal_data
from engine.editing.text.reread import RereadTree, reread
from engine.editing.text.syntax import Collection, SourceText, SyntaxTree, read_syntax
from engine.editing.text.text_rewriter import TextRewriter
from engine.errors import DocumentError, FlexcellError


class EditRefused(FlexcellError):
    """An edit cannot be applied; the document is unchanged."""


class Draft:
    """A document whose `data` may be changed freely; `text` is its current text, `given` the original text.

    Args:
        text: YAML or JSON.
        file: Its name, for positions; `.json` makes it JSON.
        reread: The tree of the text, if it has been read already.

    Raises:
        DocumentError: the text cannot be read; `where` is the position.
    """

    def __init__(self, text: str, *, file: str, reread: RereadTree | None = None) -> None:
        self.file = file
        self.given = text
        self._newline = _newline_of(text)
        self._tree = reread.tree if reread is not None else read_syntax(_plain(text), file=file)
        self._sources: dict[int, Collection] = reread.sources if reread is not None else {}
        self._borrowed: list[object] = []
        """Data with the text of other data, or of a clipboard."""
        if reread is None:
            self._take(self._tree)
        root = cast("Collection", self._tree.root)
        self.data = cast("dict[str, object]", root.data)

    @property
    def origin(self) -> SourceText:
        """The text as it was read, with its spans."""
        return self._tree.origin

    def collections(self) -> Iterator[Collection]:
        """Iterate over every collection as it was read, outer ones first."""
        return self._tree.collections()

    @property
    def sources(self) -> Mapping[int, Collection]:
        """Positions of dicts and lists in a text, by their id."""
        return self._sources

    @property
    def json(self) -> bool:
        """True for a JSON document."""
        return self._tree.origin.json

    def adopt(self, text: str) -> dict[str, object]:
        """Read another YAML mapping, whose parts keep their text wherever they are inserted.

        Raises:
            DocumentError: it cannot be read.
        """
        other = read_syntax(_plain(text), file="clipboard.yaml")
        self._take(other)
        self._borrowed += [found.data for found in other.collections()]
        return cast("dict[str, object]", cast("Collection", other.root).data)

    def copied(self, value: object) -> object:
        """Return a copy that is written with the text of the original."""
        if isinstance(value, dict):
            found = cast("dict[str, object]", value)
            return self._alike(found, {key: self.copied(each) for key, each in found.items()})
        if isinstance(value, list):
            items = cast("list[object]", value)
            return self._alike(items, [self.copied(each) for each in items])
        return copy.copy(value)

    def source_of(self, value: object) -> Collection | None:
        """Return the position of a dict or list in a text."""
        return self._sources.get(id(value))

    def text(self) -> str:
        """Return the current text of the document.

        Raises:
            EditRefused: it cannot be written without changing more than requested.
        """
        return self._in_full(self._written(self._rewriter())).given

    def rewritten(self) -> Draft:
        """Return the current document, parsed again from its text; this consumes the draft.

        Raises:
            EditRefused: it cannot be written without changing more than requested.
        """
        rewriter = self._rewriter()
        made = self._written(rewriter)
        for each in self._borrowed:
            self._sources.pop(id(each), None)
        found = reread(self._tree, made, self.data, file=self.file, sources=self._sources, changed=rewriter.changed)
        return Draft(self._with_newlines(made), file=self.file, reread=found) if found else self._in_full(made)

    def reread(self, text: str) -> Draft:
        """Return the draft of another text, of which only the lines that differ are read; this consumes the draft.

        The draft must not have been changed.

        Raises:
            DocumentError: the text cannot be read.
        """
        found = reread(self._tree, _plain(text), None, file=self.file, sources=self._sources, changed=frozenset())
        return Draft(text, file=self.file, reread=found)

    def _rewriter(self) -> TextRewriter:
        return TextRewriter(self._sources, self.json)

    def _written(self, rewriter: TextRewriter) -> str:
        return rewriter.document(self._tree, self.data)

    def _in_full(self, made: str) -> Draft:
        # Text that ends with a line feed cannot be written on a last line without one.
        again = self._read_back(made) or self._read_back(made + "\n")
        if again is None:
            hint = "edit the text directly"
            raise EditRefused("this edit does not fit the layout of the text", hint=hint)
        return again

    def _read_back(self, made: str) -> Draft | None:
        """Return the parsed text if it equals the data in type and order."""
        try:
            again = Draft(self._with_newlines(made), file=self.file)
        except DocumentError:
            return None
        return again if is_equal_data(again.data, self.data) else None

    def _with_newlines(self, made: str) -> str:
        return made.replace("\n", self._newline) if self._newline != "\n" else made

    def _take(self, tree: SyntaxTree) -> None:
        for found in tree.collections():
            self._sources[id(found.data)] = found

    def _alike(self, original: object, made: object) -> object:
        source = self._sources.get(id(original))
        if source is not None:
            self._sources[id(made)] = source
        self._borrowed.append(made)  # ids are reused after objects are deleted
        return made


def _newline_of(text: str) -> str:
    return "\r\n" if "\r\n" in text and "\n" not in text.replace("\r\n", "") else "\n"


def _plain(text: str) -> str:
    return text.replace("\r\n", "\n") if _newline_of(text) != "\n" else text
