"""Compiles every numeric kernel into the cache, where all test processes find them: `-m tests.compile_kernels`."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from robots.planning.worker.planning_worker_main import warm_up
from robots.planning.worker.scene_planner import ScenePlanner

ROOT = Path(__file__).resolve().parents[1]


def main() -> None:
    """Import what is compiled when it is imported, and plan once, which compiles the rest."""
    for file in sorted((ROOT / "robots").rglob("*kernels.py")):
        import_module(".".join(file.relative_to(ROOT).with_suffix("").parts))
    warm_up(ScenePlanner())


if __name__ == "__main__":
    main()
