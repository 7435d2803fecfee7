"""Makes the recordings of this folder anew: `python tests/replay/make_recordings.py [NAME …]`.

Needed when what happens in a run changes on purpose: a behavior, the motions, the text of an event.
Look at what `flexcell replay tests/replay/*.mcap` says before.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
PROJECT = FOLDER.parents[1]
RECORDINGS = {
    "two_arm_transfer": "behaviors/reconcycle/two_arm_transfer.yaml",
    "pick_and_place": "behaviors/pick_and_place/pick_and_place.yaml",
    "plate_transfer": "behaviors/plate_transfer/plate_transfer.yaml",
    "plate_transfer_shared": "behaviors/plate_transfer_shared/plate_transfer_shared.yaml",
    "plate_transfer_fixed": "behaviors/plate_transfer_shared/plate_transfer_fixed.yaml",
    "test_cylinder": "behaviors/test_cylinder/test_cylinder.yaml",
}
SLOW = ("--record-rate", "2", "--record-topic", "*/joint_state", "--record-topic", "cell/frames")


def make(name: str, behavior: str) -> None:
    """Run a behavior in its simulated cell, on a store of its own, and keep the recording."""
    file = FOLDER / f"{name}.mcap"
    with tempfile.TemporaryDirectory() as folder:
        store = ("--store", str(Path(folder) / "cell.db"), "--journal", "none")
        subprocess.run(
            [
                Path(sys.executable).with_name("flexcell"),
                *("run", behavior, "--clock", "virtual", "--seed", "1", "--record", str(file), *SLOW, *store),
            ],
            cwd=PROJECT,
            check=True,
        )
    sys.stdout.write(f"{file.relative_to(PROJECT)}: {file.stat().st_size} bytes\n")


if __name__ == "__main__":
    for wanted in sys.argv[1:] or RECORDINGS:
        make(wanted, RECORDINGS[wanted])
