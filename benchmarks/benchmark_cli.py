"""The command line that the benchmark scripts share: `--quick`, `--rounds N`, `--json FILE`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

from benchmarks.comparison import MeasuredTable, Table, machine, measure, report


def run_script(description: str, tables: Sequence[Table], packages: Sequence[str], *, closing: str = "") -> None:
    """Measure the tables, print each as it is done, and write the JSON file if asked to."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--quick", action="store_true", help="tiny sizes, one round: shows that it works, no figures")
    parser.add_argument("--rounds", type=int, default=5, help="fresh processes per row (default 5)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every sample to FILE")
    options = parser.parse_args()
    if options.quick:
        print("QUICK: tiny sizes, one round; the figures mean nothing, whatever the headings say.\n")
    print(f"{description}\n\nMedians of {1 if options.quick else options.rounds} processes each; {machine()}.\n")
    done: list[MeasuredTable] = []
    for table in tables:
        done.append(measure(table, rounds=1 if options.quick else options.rounds, quick=options.quick))
        print(f"{done[-1].markdown()}\n", flush=True)
    if closing:
        print(closing)
    if options.json:
        options.json.write_text(json.dumps(report(done, packages), indent=1) + "\n", encoding="utf-8")
