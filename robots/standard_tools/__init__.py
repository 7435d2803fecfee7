"""The standard kinds of tools, grippers and hands, with what simulates them; and the contract of such a simulation."""
