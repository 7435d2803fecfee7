/** Fixes of the draft's problems: fetched while a list of problems is looked at, made when one is chosen. */
import { useEffect } from 'react'
import { useLive } from '../../api/live'
import { relations } from '../../api/relations'
import type { FindingView, Fix, FixesBody } from '../../api/types'
import { perform } from './apply'
import { draftOf, useEditor } from './store'
import { pageStore } from '../../api/pageStore'

const PAUSE_MS = 200
const NONE: readonly Fix[] = []

const useFixes = pageStore<{ readonly of: string; readonly found: readonly FixesBody[] }>(() => ({ of: '', found: [] }))

/** Keep the fixes in step with the draft for as long as somebody looks; those of an earlier text fit where their finding still stands. */
export function useFreshFixes(isShown = true): readonly FixesBody[] {
  const id = useEditor((s) => s.id)
  const text = useEditor((s) => draftOf(s).text)
  const findings = useEditor((s) => draftOf(s).findings)
  // Who may look only can make none, and may not ask.
  const mayEdit = useLive((s) => s.role === 'operator')
  const isNeeded = isShown && mayEdit && findings.length > 0
  useEffect(() => {
    const of = `${id} ${text}`
    if (!isNeeded || useFixes.getState().of === of) return
    const timer = setTimeout(() => {
      // Who looks first asks, for all.
      if (useFixes.getState().of === of) return
      useFixes.setState({ of })
      relations.fixes(id, text).then(
        (found) => useFixes.getState().of === of && useFixes.setState({ found }),
        // Without fixes the problems stand as they are; the next text asks again.
        () => useFixes.setState({ of: '', found: [] }),
      )
    }, PAUSE_MS)
    return () => clearTimeout(timer)
  }, [isNeeded, id, text, findings])
  return useFixes((s) => s.found)
}

/** The fixes of one finding. */
export function fixesOf(all: readonly FixesBody[], finding: FindingView): readonly Fix[] {
  const found = all.find((each) => each.code === finding.code && each.path === finding.path && each.message === finding.message)
  return found?.fixes ?? NONE
}

/** Make a fix: one step of the history, which undo takes back. */
export function makeFix(fix: Fix): void {
  void perform(fix.title.replaceAll('`', ''), fix.edits)
}
