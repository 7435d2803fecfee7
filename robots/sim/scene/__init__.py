"""What a simulated cell consists of, as plain data, and how it is built from a cell document.

Imports no MuJoCo; planning, vision and workspace may use it.
"""
