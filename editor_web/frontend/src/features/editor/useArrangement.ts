/** Lays out what fills the canvas, again whenever the document or what is open changes; until done, the one before stays. */
import { useEffect, useRef, useState } from 'react'
import { layOutByElk, warmUpElk } from '../../components/elk'
import { arrange, type Arrangement } from '../../document/editing/arrange'
import { allNodes, type EditNode } from '../../document/editing/model'
import { drawnNodes, expansionOf } from '../../document/editing/expansion'
import { zoom, type Size } from '../../document/geometry'
import { useIsMoving } from './viewportMotion'
import { draftOf, rootOf, scopeOf, setOpensByItself, useEditor } from './store'
import type { LayoutCall } from '../../document/layout'
import { layOutRoughly } from '../../document/roughLayout'
import type { DrawnInput } from './elements'

const ROWS = [1, 1.4, 1.9, 2.6, 3.6]
/** The least zoom at which names can be read. */
const READABLE = 0.55
/** For an overview, which is seen from far away. */
const WIDE_ROWS = [...ROWS, 5, 7, 10, 14]
/** With more nodes than this the engine is asked once, for what is best by a rough look. */
const SOME = 40
/** From here on it is an overview. */
const MANY = 300

export interface Arranged extends DrawnInput {
  /** Another one than before: what fills the canvas was changed, not only edited. */
  readonly view: string
  /** Which containers had been opened and closed by hand. */
  readonly opened: ReadonlyMap<string, boolean>
}

/** Outcomes of a machine that nothing inside leads to yet: those of the behavior, and those used outside. */
export function declaredOutcomes(root: EditNode, outcomes: readonly string[]): (node: EditNode) => readonly string[] {
  return (node) => {
    if (node === root) return outcomes
    return node.outcomes
  }
}

export function useArrangement(pane: Size | undefined): { arranged: Arranged | undefined; problem: string } {
  const root = useEditor(rootOf)
  const outcomes = useEditor((s) => draftOf(s).document?.outcomes)
  const scope = useEditor(scopeOf)
  const opened = useEditor((s) => s.opened)
  const [arranged, setArranged] = useState<Arranged>()
  const [problem, setProblem] = useState('')
  // Chosen once for what fills the canvas, so that an edit does not move everything.
  const chosen = useRef<Chosen & { scope: string; isMany: boolean }>(undefined)
  const measured = pane !== undefined

  useEffect(() => {
    if (!root || !scope || !measured) return
    let current = true
    const declared = declaredOutcomes(root, outcomes ?? [])
    async function run(whole: EditNode, filling: EditNode, area: Size): Promise<void> {
      const begun = performance.now()
      const laidOut = async ({ limit, opens }: Chosen, call: LayoutCall) => {
        const isOpen = expansionOf(filling, opened, opens)
        const arrangement = await arrange(filling, { isOpen, declared, rowLimit: limit, call })
        return { limit, opens, isOpen, arrangement }
      }
      const drawn = drawnNodes(filling, expansionOf(filling, opened, chosen.current?.opens)).length
      const first = drawn > SOME ? layOutRoughly : layOutByElk
      const isMany = drawn > MANY
      const isSame = chosen.current?.scope === filling.path && chosen.current.isMany === isMany
      const known = isSame ? chosen.current : undefined
      const widths = (isMany ? WIDE_ROWS : ROWS).map((factor) => factor * area.width)
      const bestOf = async (opens: boolean) => {
        const look = (limit: number) => laidOut({ limit, opens }, first)
        return (await (isMany ? inTurn(widths, look) : Promise.all(widths.map(look)))).reduce(better(area))
      }
      let best = known ? await laidOut(known, layOutByElk) : await bestOf(true)
      // Where everything at once is too small to be read, what is inside is shown on demand.
      if (!known && !isMany && zoom(best.arrangement.size, area) < READABLE) best = await bestOf(false)
      if (!known && first !== layOutByElk) best = await laidOut(best, layOutByElk)
      performance.measure('flexcell:layout', { start: begun })
      if (!current) return
      chosen.current = { scope: filling.path, limit: best.limit, opens: best.opens, isMany }
      setOpensByItself(best.opens)
      setArranged({
        root: whole,
        scope: filling,
        arrangement: best.arrangement,
        isOpen: best.isOpen,
        declared,
        view: filling.path,
        opened,
      })
      setProblem('')
      if (allNodes(whole).length > SOME) warmUpElk()
    }
    run(root, scope, pane ?? { width: 1, height: 1 }).catch((error: unknown) => {
      if (current) setProblem(error instanceof Error ? error.message : String(error))
    })
    return () => {
      current = false
    }
    // oxlint-disable-next-line react/exhaustive-deps -- the pane counts when the row length is chosen
  }, [root, scope, opened, outcomes, measured])
  return { arranged, problem }
}

interface Chosen {
  /** Length of a row. */
  readonly limit: number
  /** Are containers open by themselves? */
  readonly opens: boolean
}

/** One look at a thousand nodes takes a moment: what the user does comes in between. */
async function inTurn<A, B>(all: readonly A[], look: (each: A) => Promise<B>): Promise<readonly B[]> {
  const seen: B[] = []
  for (const each of all) {
    await new Promise((proceed) => setTimeout(proceed))
    seen.push(await look(each))
  }
  return seen
}

function better(area: Size) {
  return <T extends { arrangement: Arrangement }>(a: T, b: T): T =>
    zoom(b.arrangement.size, area) > zoom(a.arrangement.size, area) * 1.06 ? b : a
}

/** Is what is drawn another than what is to be seen, or on its way? */
export function useIsBusy(drawn: Arranged | undefined): boolean {
  const isDrawn = useEditor(
    (s) => drawn !== undefined && drawn.root === rootOf(s) && drawn.scope === scopeOf(s) && drawn.opened === s.opened,
  )
  const isMoving = useIsMoving()
  return isMoving || !isDrawn
}
