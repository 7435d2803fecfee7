"""A child that computes without looking at its socket ends with its parent all the same."""

from __future__ import annotations

import os
import select
import socket
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]

CHILD = """
import socket, sys
from engine.host.child_process import set_parent_death_signal
connection = socket.socket(fileno=int(sys.argv[1]))
set_parent_death_signal(connection)
connection.sendall(b"x")
while True:
    pass
"""
PARENT = """
import socket, sys, time
from engine.host.child_process import start_child
ours, theirs = socket.socketpair()
child = start_child(sys.argv[1], (theirs.fileno(),), what="a child")
theirs.close()
ours.recv(1)
print(child.pid, flush=True)
time.sleep(1000)
"""


def test_a_child_in_the_midst_of_its_work_ends_with_its_parent() -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT, CHILD], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    assert parent.stdout is not None
    child = os.pidfd_open(int(parent.stdout.readline()))
    assert select.select([child], [], [], 0.0)[0] == []
    parent.kill()
    parent.communicate()
    # The descriptor can be read once the process has ended.
    ended, _, _ = select.select([child], [], [], 60.0)
    os.close(child)
    assert ended


def test_a_child_whose_parent_has_ended_already_ends() -> None:
    ours, theirs = socket.socketpair()
    ours.close()
    child = subprocess.run(
        [sys.executable, "-c", CHILD, str(theirs.fileno())],
        pass_fds=(theirs.fileno(),),
        cwd=ROOT,
        timeout=60.0,
        check=False,
    )
    theirs.close()
    assert child.returncode == 0
