/** Targets that an arm of the document's cell cannot be at: asked for when nothing was changed for a moment, of the newest text. */
import { wordsOf } from '../../api/client'
import { documents } from '../../api/documents'
import type { FindingView } from '../../api/types'
import { sameFindings } from '../../document/editing/findings'
import { replaced } from '../../document/editing/history'
import type { Draft } from '../../document/editing/model'
import { Pause } from '../../document/pause'
import { mayAsk } from './checking'
import { draftOf, editor, setEditor } from './store'
import { pageStore } from '../../api/pageStore'

/** What such a target counts as, as `--targets` of `flexcell check`. */
export type TargetLevel = 'warning' | 'error' | 'off'

const PAUSE_MS = 400
const KEPT = 'flexcell.targets'
const PAGE = crypto.randomUUID()

/** The level, and why the targets are not known. */
export const useTargets = pageStore<{ readonly level: TargetLevel; readonly problem: string }>(() => ({
  level: keptLevel(),
  problem: '',
}))

const pause = pageStore(
  () => new Pause(),
  (ended) => ended.cancel(),
)

/** Ask for the targets of the present text, soon; whatever was asked for before is not wanted any more. */
export function lookForTargets(): void {
  pause.getState().later(PAUSE_MS, () => void look())
}

async function look(): Promise<void> {
  const { id } = editor()
  const { text, areTargetsKnown } = draftOf(editor())
  const { level } = useTargets.getState()
  if (areTargetsKnown || !id || level === 'off' || !(await mayAsk())) return
  try {
    const answer = await documents.targets(id, text, PAGE)
    const isCurrent = editor().id === id && draftOf(editor()).text === text && useTargets.getState().level === level
    if (answer.dropped || !isCurrent) return
    useTargets.setState({ problem: answer.problem })
    take(
      answer.findings.map((each): FindingView => ({ ...each, severity: level })),
      true,
    )
  } catch (error) {
    useTargets.setState({ problem: wordsOf(error) })
  }
}

function take(targets: Draft['targets'], areTargetsKnown: boolean): void {
  const now = draftOf(editor())
  const draft = { ...now, targets: sameFindings(now.targets, targets), areTargetsKnown }
  setEditor({ history: replaced(editor().history, draft) })
}

export function setTargetLevel(level: TargetLevel): void {
  useTargets.setState({ level, problem: '' })
  try {
    localStorage.setItem(KEPT, level)
  } catch {
    // A browser that keeps nothing: the level lives as long as the page.
  }
  take([], false)
  lookForTargets()
}

function keptLevel(): TargetLevel {
  try {
    const kept = localStorage.getItem(KEPT)
    return kept === 'error' || kept === 'off' ? kept : 'warning'
  } catch {
    return 'warning'
  }
}
