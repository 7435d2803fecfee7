"""The exit codes of the commands; scripts and CI depend on them."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """Exit code of the process."""

    SUCCESS = 0
    """The outcome is one of `success`."""
    OTHER_OUTCOME = 1
    """Another outcome."""
    BAD_INPUT = 2
    """Invalid usage or document; nothing was started."""
    ERRORED = 3
    """The run ended with an error."""
    REPLAY_DIFFERS = 4
    """A replay differs from the recording."""
    UNDECIDED = 5
    """A sweep cannot say yet whether what is required of it is reached."""
    INTERRUPTED = 130
    """Stopped by Ctrl-C or a signal; robots at rest, journal closed."""
