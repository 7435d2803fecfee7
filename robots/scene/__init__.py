"""What a cell consists of, as plain data, and how it is read from a cell document.

Imports no MuJoCo; the simulator and whoever plans and looks around in the same cell use it.
"""
