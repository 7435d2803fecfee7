"""Runs one job of one peer in this process and prints the sample as JSON: `worker MODULE:JOB AT_LEAST_S SIZE…`."""

from __future__ import annotations

import dataclasses
import importlib
import json
import sys
from collections.abc import Callable

from benchmarks.sample import Sample, Stopwatch


def main(job: str, at_least_s: str, *sizes: str) -> None:
    """Run `module:function` of `benchmarks.peers`; a missing library is an answer, not a failure."""
    module, _, function = job.partition(":")
    try:
        work: Callable[..., Sample] = getattr(importlib.import_module(f"benchmarks.peers.{module}"), function)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] in ("benchmarks", "engine"):
            raise
        print(json.dumps({"missing": error.name}))
        return
    print(json.dumps(dataclasses.asdict(work(Stopwatch(float(at_least_s)), *map(int, sizes)))))


if __name__ == "__main__":
    main(*sys.argv[1:])
