"""An emulated FR3 with its hand: franky-sim in a process of its own, and a proxy before it that causes faults."""
