"""The composition root: the one place that opens a cell and makes runs in it, and sessions of several runs.

`cell_runner` composes: a `RunRequest` becomes a run with its cell, bus, journal, recording and faults. The command
line, the dashboard, the pytest plugin, scripts and notebooks all start their runs there.
"""
