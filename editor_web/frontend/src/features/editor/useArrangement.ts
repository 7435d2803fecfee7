/** Lays out what fills the canvas, again whenever the document or what is open changes; until done, the one before stays. */
import { useEffect, useRef, useState } from 'react'
import { loadElk } from '../../components/elk'
import { arrange, type Arrangement } from '../../document/editing/arrange'
import type { EditNode } from '../../document/editing/model'
import { openness } from '../../document/editing/opening'
import { zoom, type Size } from '../../document/geometry'
import { draftOf, scopeOf, setOpensByItself, useEditor } from './store'
import type { DrawnInput } from './elements'

const ROWS = [1, 1.4, 1.9, 2.6, 3.6]
/** The least zoom at which names can be read. */
const READABLE = 0.55

export interface Arranged extends DrawnInput {
  /** Another one than before: what fills the canvas was changed, not only edited. */
  readonly view: string
}

/** Outcomes of a machine that nothing inside leads to yet: those of the behavior, and those used outside. */
export function declaredOutcomes(root: EditNode, outcomes: readonly string[]): (node: EditNode) => readonly string[] {
  return (node) => {
    if (node === root) return outcomes
    return node.outcomes
  }
}

export function useArrangement(pane: Size | undefined): { arranged: Arranged | undefined; problem: string } {
  const root = useEditor((s) => draftOf(s).root)
  const outcomes = useEditor((s) => draftOf(s).document?.outcomes)
  const scope = useEditor(scopeOf)
  const opened = useEditor((s) => s.opened)
  const [arranged, setArranged] = useState<Arranged>()
  const [problem, setProblem] = useState('')
  // Chosen once for what fills the canvas, so that an edit does not move everything.
  const chosen = useRef<Chosen & { scope: string }>(undefined)
  const measured = pane !== undefined

  useEffect(() => {
    if (!root || !scope || !measured) return
    let current = true
    const declared = declaredOutcomes(root, outcomes ?? [])
    async function run(whole: EditNode, filling: EditNode, area: Size): Promise<void> {
      const call = await loadElk()
      const laidOut = async ({ limit, opens }: Chosen) => {
        const isOpen = openness(filling, opened, opens)
        return {
          limit,
          opens,
          isOpen,
          arrangement: await arrange(filling, { isOpen, declared, rowLimit: limit, call }),
        }
      }
      const known = chosen.current?.scope === filling.path ? chosen.current : undefined
      const widths = ROWS.map((factor) => factor * area.width)
      const all = await Promise.all((known ? [known] : widths.map((limit) => ({ limit, opens: true }))).map(laidOut))
      let best = all.reduce(better(area))
      // Where everything at once is too small to be read, what is inside is shown on demand.
      if (!known && zoom(best.arrangement.size, area) < READABLE) {
        best = (await Promise.all(widths.map((limit) => laidOut({ limit, opens: false })))).reduce(better(area))
      }
      if (!current) return
      chosen.current = { scope: filling.path, limit: best.limit, opens: best.opens }
      setOpensByItself(best.opens)
      setArranged({
        root: whole,
        scope: filling,
        arrangement: best.arrangement,
        isOpen: best.isOpen,
        declared,
        view: filling.path,
      })
      setProblem('')
    }
    run(root, scope, pane ?? { width: 1, height: 1 }).catch((error: unknown) => {
      if (current) setProblem(error instanceof Error ? error.message : String(error))
    })
    return () => {
      current = false
    }
    // eslint-disable-next-line react-hooks/exhaustive-deps -- the pane counts when the row length is chosen
  }, [root, scope, opened, outcomes, measured])
  return { arranged, problem }
}

interface Chosen {
  /** Length of a row. */
  readonly limit: number
  /** Are containers open by themselves? */
  readonly opens: boolean
}

function better(area: Size) {
  return <T extends { arrangement: Arrangement }>(a: T, b: T): T =>
    zoom(b.arrangement.size, area) > zoom(a.arrangement.size, area) * 1.06 ? b : a
}
