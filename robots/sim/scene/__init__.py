"""The scene of a simulated cell as plain data, and its construction from a cell document.

Imports no MuJoCo; planning, vision and workspace may use it.
"""
