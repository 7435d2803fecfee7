"""What is measured: one module per engine or message channel, each with the same jobs as functions.

A job takes a `Stopwatch` and its sizes and returns a `Sample`. A module has the jobs its library can do.
"""
