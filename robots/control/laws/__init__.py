"""Control laws: the torques that hold an arm at its set point. For the control loop and the validation of settings."""
