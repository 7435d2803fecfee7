"""The workspace shared by the arms of a cell: its live planning scene, its planners and its path monitoring.

`Workspace` is the device. It consists of `LiveScene` (objects, attached parts and allowed contacts),
`PlanningServices` (the planning processes and their life cycle) and the `MeasuredPoses` of a world.
"""
