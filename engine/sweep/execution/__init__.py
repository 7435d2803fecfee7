"""How configurations are executed on this machine: one run, its process, and a pool of such processes.

`trial_execution` is what a sweep asks of an executor, here or on a cluster. Nothing in this room knows of statistics,
which a worker does not load.
"""
