"""Commands to the control loop of an arm, simulated or real: messages, their handling, and the port that sends them.

The control loop may run in this process or another one; the port and its motions belong to the event loop.
"""
