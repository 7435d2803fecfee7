"""The control loop of a simulated world: one step of physics, arms, tools and people.

And the snapshot of its state. For robots.sim.host.
"""
