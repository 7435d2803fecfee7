"""Benchmarks: each script prints its tables from one run; see `docs/benchmarks.md`.

The measured code runs in fresh processes (`worker`), so nothing here imports what it measures.
"""
