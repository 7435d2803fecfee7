"""Motion generators: the set point of an arm in every control period, for each kind of motion."""
