"""A run as it was at any moment of it, folded from its events by what also folds the live view.

`Pasts` opens runs of this server, of the journal and recordings as `PastRun`; one gives its timeline, its moments
and, where it failed, how.
"""

from editor_web.past.failure import Failure
from editor_web.past.moments import Moment
from editor_web.past.opened import OpenedRun, Pasts
from editor_web.past.timeline import Timeline

__all__ = ["Failure", "Moment", "OpenedRun", "Pasts", "Timeline"]
