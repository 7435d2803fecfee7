"""The MuJoCo model of a scene: specifications of arms, tools and people, typed access to the state, contacts.

For the other packages of sim, and for vision, which renders a copy.
"""
