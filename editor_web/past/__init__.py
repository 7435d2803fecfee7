"""The state of a run at any point in time, reduced from its events as in the live view.

`OpenRunCache` opens runs of this server, of the journal and of recordings as `OpenRun`, which gives the timeline, the
states over time and, for a failed run, the failure.
"""

from editor_web.past.failure import RunFailure
from editor_web.past.measured_marker import MeasuredMarkers
from editor_web.past.open_runs import OpenRun, OpenRunCache
from editor_web.past.state_history import PastRunState
from editor_web.past.timeline import Timeline

__all__ = ["MeasuredMarkers", "OpenRun", "OpenRunCache", "PastRunState", "RunFailure", "Timeline"]
