"""Run ids: behavior name and wall time, with a random suffix that makes them unique."""

from __future__ import annotations

import re
import secrets
from datetime import UTC, datetime


def new_run_id(behavior: str) -> str:
    """Return a run id such as `two_arm_transfer-20260401-101530-3fa2c81e`, safe in paths and URLs."""
    word = re.sub(r"[^A-Za-z0-9]+", "_", behavior).strip("_")[:48] or "run"
    return f"{word}-{datetime.now(UTC):%Y%m%d-%H%M%S}-{secrets.token_hex(4)}"
