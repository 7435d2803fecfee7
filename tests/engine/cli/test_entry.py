"""The command line looks for no garbage while it is loaded: nothing of that becomes any."""

from __future__ import annotations

import subprocess
import sys

PROGRAM = """
import gc, sys
early = []
def look(phase, info):
    if not hasattr(sys.modules.get("engine.cli.commands.run"), "refuse_errors"):
        early.append(phase)
gc.callbacks.append(look)
sys.argv = ["flexcell", *{arguments!r}]
from engine.cli.entry import main
early.clear()
try:
    main()
except SystemExit as left:
    print(left.code, early, gc.isenabled(), file=sys.stderr)
"""


def output(*arguments: str) -> str:
    command = [sys.executable, "-P", "-c", PROGRAM.format(arguments=arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stderr


def test_the_collector_waits_until_the_command_is_loaded_and_works_afterwards() -> None:
    assert output("run", "--help") == "0 [] True\n"


def test_a_command_that_does_not_exist_is_refused_as_ever() -> None:
    assert "No such command 'rnu'" in output("rnu")
