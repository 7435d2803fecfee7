"""Commands to a simulated world, as messages to its process. For the other packages of sim."""
