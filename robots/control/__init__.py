"""What runs in every control period: set points, torques, the collision reflex, the drives of tools."""
