"""Collision-free motion: the planning scene, an exact checker, planners behind one request, and their timing.

`PlanningScene` says what there is, as data. `ScenePlanner` answers a `PlanRequest` in this process;
`PlanningWorker` does so in a process of its own, because the exact checker and OMPL keep the
interpreter lock. `ExactChecker` tells what touches what. Import from the modules: this package loads
nothing by itself.
"""
