"""Tools that are switched by digital outputs of another device: options, motion, and what is known of them.

A kind of tool adds a port and a server on a `SwitchedDrive`; `engine.cell.ToolKind.switched` names them.
"""
