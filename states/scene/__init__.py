"""States that change the planning scene: obstacles, attached parts and allowed contacts."""
