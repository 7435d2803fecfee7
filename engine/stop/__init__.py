"""The stop of a cell, independent of every event loop: a separate process between operators and controllers.

The relay's process receives STOP over HTTP and by signals and forwards it to every *stop line*, a socket that the
process of a controller or driver reads itself. The engine is notified at the same time; the stop does not depend on it.
"""

from engine.stop.relay import StopEndpoint, StopRelay
from engine.stop.relay_messages import DeviceStop, StopNotice, StopStatus
from engine.stop.stop_line import StopLine

__all__ = ["DeviceStop", "StopEndpoint", "StopLine", "StopNotice", "StopRelay", "StopStatus"]
