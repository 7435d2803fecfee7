"""Where a simulated world runs: in lockstep in this process, or in real time in a process of its own.

For the ports and robots.sim.world.
"""
