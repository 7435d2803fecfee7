"""The MuJoCo model of a scene: specifications of arms, tools and people, typed access to the state, contacts.

For the other rooms of sim, and for vision, which renders a copy.
"""
