"""A kind of tool in one folder: the switchable magnet, from its mechanism to its states and what simulates it.

Only the table of tool kinds (`robots/tool_kinds.py`) names it. `magnet_kind.py` is where to begin.
"""

ICON = "gripper"
"""The name of the icon of its states."""
