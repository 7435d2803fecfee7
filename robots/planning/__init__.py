"""Collision-free motion: the planning scene, an exact checker, planners behind one request, and time parameterization.

`PlanningScene` describes the scene as data. `ScenePlanner` answers a `PlanRequest` in this process;
`PlanningWorker` answers it in a separate process, because the exact checker and OMPL hold the
interpreter lock. `ExactChecker` reports contacts. Import from the modules: this package loads
nothing by itself.
"""
