"""Commands to a simulated world, as messages that cross the border to its process. For the other rooms of sim."""
