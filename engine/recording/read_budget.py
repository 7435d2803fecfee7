"""Limits the work that reading a recording may cause, in proportion to its file size.

A file of a few bytes can claim to decompress to terabytes, or contain millions of empty records. The limits permit
real recordings (repetitive JSON is compressed to about a hundredth) and reject everything else with an
error message. Each read of a file has one `ReadBudget`.
"""

from __future__ import annotations

MAX_FILE = 16 * 2**30
"""Maximum size of a recording in bytes."""
MAX_RECORD = 128 * 2**20
"""Maximum size of one record in the file, in bytes."""
MAX_CHUNK = 64 * 2**20
"""Maximum decompressed size of one chunk, in bytes."""
MAX_INDEX = 64 * 2**20
"""Maximum size of the index at the end of a file, in bytes."""
MAX_DOCUMENTS = 64 * 2**20
"""Maximum size of all attachments and metadata, in bytes."""
MAX_NAMES = 4096
"""Maximum number of attachments and metadata records."""
MAX_KEPT = 2**30
"""Maximum size of the messages of one topic in memory, in bytes."""
_MESSAGE_BYTES = 500
_FREE_BYTES, _TIMES_UNFOLDED = 64 * 2**20, 300
_FREE_RECORDS, _RECORDS_A_BYTE = 200_000, 0.25


class ReadBudget:
    """Remaining budget while one file is read; each method raises ValueError if a limit is exceeded."""

    def __init__(self, size: int) -> None:
        if size > MAX_FILE:
            raise ValueError(f"it has {size} bytes, more than {MAX_FILE}")
        self._unfolded = _FREE_BYTES + _TIMES_UNFOLDED * size
        self._records = _FREE_RECORDS + int(_RECORDS_A_BYTE * size)
        self._documents = MAX_DOCUMENTS
        self._names = MAX_NAMES
        self._kept = MAX_KEPT

    def take_record(self, size: int) -> None:
        """Count a record of this size in the file or in a chunk."""
        if size > MAX_RECORD:
            raise ValueError(f"a record declares {size} bytes, more than {MAX_RECORD}")
        self._records -= 1
        if self._records < 0:
            raise ValueError("it has more records than a file of its size can hold")

    def take_chunk(self, size: int) -> None:
        """Count a chunk with this declared decompressed size."""
        if not 0 <= size <= MAX_CHUNK:
            raise ValueError(f"a chunk declares {size} decompressed bytes, more than {MAX_CHUNK}")
        self._unfolded -= size
        if self._unfolded < 0:
            raise ValueError(f"it decompresses to more than {_TIMES_UNFOLDED} times its size")

    def take_document(self, size: int) -> None:
        """Count an attachment or a metadata record that is kept."""
        self._names -= 1
        self._documents -= size
        if self._names < 0 or self._documents < 0:
            raise ValueError(f"its documents are more than {MAX_NAMES}, or have more than {MAX_DOCUMENTS} bytes")

    def take_message(self, size: int) -> None:
        """Count a message that is kept."""
        self._kept -= size + _MESSAGE_BYTES
        if self._kept < 0:
            raise ValueError(f"the messages of one topic take more than {MAX_KEPT} bytes")
