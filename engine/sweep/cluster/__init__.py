"""Sweeps on a Dask cluster that exists; needs the extra `dask`, on this machine, the scheduler and the workers.

`cluster_executor` is the `TrialExecutor` of the driver, `shipment` the files that workers are sent, and `remote_run`
what they execute.
"""
