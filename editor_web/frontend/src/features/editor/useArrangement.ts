/** Lays out what fills the canvas, again whenever the document or what is open changes; until done, the one before stays. */
import { useEffect, useRef, useState } from 'react'
import { layOutByElk, warmUpElk } from '../../components/elk'
import { arrange } from '../../document/editing/arrange'
import { allNodes, type EditNode } from '../../document/editing/model'
import { declaredOutcomes, expandedByDefault, expansionOf, rowLimitOf } from '../../document/editing/expansion'
import { useIsMoving } from './viewportMotion'
import { draftOf, editor, rootOf, scopeOf, setEditor, useEditor } from './store'
import type { DrawnInput } from './elements'

/** With more nodes than this the engine is loaded ahead of what is asked for next. */
const SOME = 40

export interface Arranged extends DrawnInput {
  /** Another one than before: what fills the canvas was changed, not only edited. */
  readonly view: string
  /** Which containers had been opened and closed by hand. */
  readonly opened: ReadonlyMap<string, boolean>
}

/** The arrangement of what fills the canvas: what the document says, and which containers are open, is all it depends on. */
export function useArrangement(): { arranged: Arranged | undefined; problem: string } {
  const root = useEditor(rootOf)
  const outcomes = useEditor((s) => draftOf(s).document?.outcomes)
  const scope = useEditor(scopeOf)
  const opened = useEditor((s) => s.opened)
  const [arranged, setArranged] = useState<Arranged>()
  const [problem, setProblem] = useState('')
  const kept = useRef<{ readonly scope: string; readonly open: ReadonlySet<string> }>(undefined)

  useEffect(() => {
    if (!root || !scope) return
    let current = true
    const declared = declaredOutcomes(root, outcomes ?? [])
    async function run(whole: EditNode, filling: EditNode): Promise<void> {
      const begun = performance.now()
      if (kept.current?.scope !== filling.path) kept.current = { scope: filling.path, open: expandedByDefault(filling) }
      const { open } = kept.current
      const isOpen = expansionOf(filling, opened, open)
      const arrangement = await arrange(filling, { isOpen, declared, rowLimit: rowLimitOf(filling, isOpen), call: layOutByElk })
      performance.measure('flexcell:layout', { start: begun })
      if (!current) return
      if (editor().keptOpen !== open) setEditor({ keptOpen: open })
      setArranged({ root: whole, scope: filling, arrangement, isOpen, declared, view: filling.path, opened })
      setProblem('')
      if (allNodes(whole).length > SOME) warmUpElk()
    }
    run(root, scope).catch((error: unknown) => {
      if (current) setProblem(error instanceof Error ? error.message : String(error))
    })
    return () => {
      current = false
    }
  }, [root, scope, opened, outcomes])
  return { arranged, problem }
}

/** Is what is drawn another than what is to be seen, or on its way? */
export function useIsBusy(drawn: Arranged | undefined): boolean {
  const isDrawn = useEditor(
    (s) => drawn !== undefined && drawn.root === rootOf(s) && drawn.scope === scopeOf(s) && drawn.opened === s.opened,
  )
  const isMoving = useIsMoving()
  return isMoving || !isDrawn
}
