"""The space that the arms of a cell share: its live planning scene, who plans in it, who watches ways in it.

`Workspace` is the device; it is made of `LiveScene` (what is where, and what may touch), `Planners` (the
planning services and their life) and what a world tells of itself (`Seen`).
"""
