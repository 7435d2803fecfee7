"""Plays the device's side of a capture back to its driver, so that a trace of the field becomes a regression test.

A program of its own, as the emulators; nothing of a cell imports it.
"""
