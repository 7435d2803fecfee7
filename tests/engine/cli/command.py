"""Runs the installed `flexcell` command as a user would."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

FLEXCELL = Path(sys.executable).with_name("flexcell")


@dataclass(frozen=True)
class Said:
    """What the command printed and its exit code."""

    code: int
    out: str
    err: str


def flexcell(*arguments: str | Path, cwd: Path) -> Said:
    """Run the command to its end."""
    done = subprocess.run(
        [FLEXCELL, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=100, check=False
    )
    return Said(done.returncode, done.stdout, done.stderr)
