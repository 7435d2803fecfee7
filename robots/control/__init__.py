"""Control laws that run at every step: impedance on gravity and Coriolis compensation, playback, fingers."""
