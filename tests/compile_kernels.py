"""Compiles every numeric kernel into the cache, where all test processes find them: `-m tests.compile_kernels`."""

from __future__ import annotations

import asyncio
from importlib import import_module
from pathlib import Path

from robots.planning.worker import PlanningWorker

ROOT = Path(__file__).resolve().parents[1]


async def main() -> None:
    """Import what is compiled when it is imported, and start a planner, which compiles the rest."""
    for file in sorted((ROOT / "robots").rglob("*kernels.py")):
        import_module(".".join(file.relative_to(ROOT).with_suffix("").parts))
    async with PlanningWorker():
        pass


if __name__ == "__main__":
    asyncio.run(main())
