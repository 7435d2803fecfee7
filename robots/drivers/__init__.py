"""Drivers of real devices: what they share here, one room a device family; each with an emulator beside it.

Only their entry points are used from outside. A driver imports ports and servers, no simulator.
"""
