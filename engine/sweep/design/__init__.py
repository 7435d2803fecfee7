"""Which configurations a sweep executes: factors with their distributions, and the designs that combine them.

A `configuration` is what differs in one run. The rooms above execute it, find it again, and judge how it ended.
"""
