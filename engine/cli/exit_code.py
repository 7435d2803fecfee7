"""The exit codes, which scripts and CI rely on."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """What the process says when it ends."""

    SUCCESS = 0
    """The outcome is one of `success`."""
    OTHER_OUTCOME = 1
    """Another outcome."""
    BAD_INPUT = 2
    """Bad usage or document; nothing was started."""
    ERRORED = 3
    """The run ended with an error."""
    REPLAY_DIFFERS = 4
    """A replay did not do what the recording did."""
    INTERRUPTED = 130
    """Stopped by Ctrl-C or a signal; robots at rest, journal closed."""
