"""The stop of a cell on a path that no event loop can delay: a process of its own between people and controllers.

The relay's process takes STOP from HTTP and signals and passes it to every *stop line*, a socket that the process
of a controller or driver reads by itself. The engine is told at the same time; whether it answers changes nothing.
"""

from engine.stop.relay import StopEndpoint, StopRelay
from engine.stop.relay_messages import DeviceStop, StopNotice, StopStatus
from engine.stop.stop_line import StopLine

__all__ = ["DeviceStop", "StopEndpoint", "StopLine", "StopNotice", "StopRelay", "StopStatus"]
