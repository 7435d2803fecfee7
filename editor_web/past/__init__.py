"""A run as it was at any moment of it, folded from its events by what also folds the live view.

`OpenRunCache` opens runs of this server, of the journal and recordings as `PastRun`; one gives its timeline, its
states over time and, where it failed, how.
"""

from editor_web.past.failure import RunFailure
from editor_web.past.open_runs import OpenRun, OpenRunCache
from editor_web.past.state_history import PastRunState
from editor_web.past.timeline import Timeline

__all__ = ["OpenRun", "OpenRunCache", "PastRunState", "RunFailure", "Timeline"]
