"""An emulated Universal Robots controller: RTDE, dashboard, script ports and a URScript interpreter.

A program of its own, `python -m robots.drivers.universal_robots.emulator`; nothing of a cell imports it. It executes
the programs that clients upload, so the client library's own script works on it as on a controller.
"""
