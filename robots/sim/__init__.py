"""MuJoCo simulation of a cell: world, simulated arms and grippers, hosts for virtual and real time."""
