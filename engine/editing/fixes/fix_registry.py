"""Registry of fixes: maps each kind of finding to the function that creates its fixes; others have no fix."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from engine.editing.edits.edit_session import EditSession
from engine.editing.fixes import declaration_fixes as declarations
from engine.editing.fixes import parameter_fixes as parameters
from engine.editing.fixes import policy_fixes as conduct
from engine.editing.fixes import transition_fixes
from engine.editing.fixes import userdata_fixes as keys
from engine.editing.fixes.fix import MAX_FIXES, Fix, FixContext, quoted_names
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft
from engine.errors import DocumentError
from engine.library.behavior_library import FindingView

FixMaker = Callable[[FixContext], Iterator[Fix]]
_ELSEWHERE = re.compile(r"^[^`:]+\.(?:ya?ml|json):\d+: ")
_NAMELESS = ("uncovered-combination", "constant-guard", "idle-retry")
_MAKERS: Mapping[str, FixMaker] = {
    "unconnected-outcome": transition_fixes.unconnected,
    "unknown-outcome": transition_fixes.unknown_outcome,
    "unused-outcome": transition_fixes.unused_outcome,
    "unknown-target": transition_fixes.unknown_target,
    "missing-initial": transition_fixes.missing_initial,
    "unreachable-node": transition_fixes.unreachable,
    "ambiguous-target": transition_fixes.ambiguous,
    "unknown-child": transition_fixes.unknown_child,
    "preempts-itself": transition_fixes.preempts_itself,
    "uncovered-combination": transition_fixes.uncovered,
    "unknown-state": parameters.unknown_state,
    "unknown-parameter": parameters.unknown,
    "missing-parameter": parameters.missing,
    "bad-parameter": parameters.bad,
    "unknown-input": keys.unknown_input,
    "unknown-output": keys.unknown_output,
    "undefined-key": keys.undefined,
    "maybe-undefined-key": keys.maybe_undefined,
    "unused-parameter": declarations.unused_parameter,
    "unknown-success": declarations.unknown_success,
    "constant-guard": conduct.constant_guard,
    "idle-retry": conduct.idle_retry,
    "autonomy-never-passes": conduct.autonomy_never_passes,
    "bad-resume": conduct.bad_resume,
}


def fixes_of(
    text: str, findings: Sequence[FindingView], *, file: str, context: ProjectContext
) -> tuple[tuple[Fix, ...], ...]:
    """Return the fixes of each finding of a text, in the order of the findings; often none.

    Args:
        text: The document that the findings are of.
        findings: The findings of the check.
        file: Name of the document.
        context: The states and behaviors around it.
    """
    try:
        session = EditSession(Draft(text, file=file), context)
    except DocumentError:
        return tuple(() for _ in findings)
    return tuple(_of(session, finding) for finding in findings)


def _of(session: EditSession, finding: FindingView) -> tuple[Fix, ...]:
    maker = _MAKERS.get(finding.code)
    ref = session.outline.refs.get(finding.path)
    # Findings in a referenced behavior are fixed in its own document.
    if maker is None or ref is None or _ELSEWHERE.match(finding.message):
        return ()
    names = quoted_names(finding)
    if not names and finding.code not in _NAMELESS:
        return ()
    place = FixContext(finding=finding, session=session, ref=ref, names=names)
    return tuple(maker(place))[:MAX_FIXES]
