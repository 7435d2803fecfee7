/** The layout engine in its worker; both are loaded when the first graph is drawn, or ahead of a large one. */
import { anonymous } from '../document/anonymous'
import type { ElkShape, LayoutCall } from '../document/elkGraph'

/** So many graphs are remembered: those of a large behavior in several widths. */
const KEPT = 600

/** Lay out one graph in the worker; what was laid out before is known, also under other names. */
export const layOutByElk: LayoutCall = async (given) => {
  const { graph, named } = anonymous(given)
  return named(await answers.to(graph))
}

/** Load the engine and let it lay out a little, so that the first who needs it need not wait for that. */
export function warmUpElk(): void {
  if (answers.hasEngine) return
  const call = () => void layOutByElk(SMALL).catch(() => undefined)
  // Safari has no idle callbacks.
  if ('requestIdleCallback' in globalThis) requestIdleCallback(call)
  else setTimeout(call, 500)
}

/** What the engine has answered: a graph has one layout, whoever asks. */
class Answers {
  private readonly known = new Map<string, Promise<ElkShape>>()
  private engine: Promise<LayoutCall> | undefined

  get hasEngine(): boolean {
    return this.engine !== undefined
  }

  to(graph: ElkShape): Promise<ElkShape> {
    const key = JSON.stringify(graph)
    const known = this.known.get(key)
    if (known) return known
    this.engine ??= start()
    const answer = this.engine.then((call) => call(graph))
    this.known.set(key, answer)
    answer.catch(() => this.known.delete(key))
    const oldest = this.known.size > KEPT ? this.known.keys().next().value : undefined
    if (oldest !== undefined) this.known.delete(oldest)
    return answer
  }
}

const answers = new Answers()

async function start(): Promise<LayoutCall> {
  const [{ default: Elk }, { default: ElkWorker }] = await Promise.all([
    import('elkjs/lib/elk-api.js'),
    import('elkjs/lib/elk-worker.min.js?worker'),
  ])
  const elk = new Elk({ workerFactory: () => new ElkWorker() })
  return ((graph) => elk.layout(graph as Parameters<typeof elk.layout>[0])) as LayoutCall
}

/** One node follows another. */
const SMALL: ElkShape = {
  id: '',
  children: ['a', 'b'].map((id) => ({ id, width: 10, height: 10 })),
  edges: [{ id: 'a b', sources: ['a'], targets: ['b'] }],
  layoutOptions: { 'elk.algorithm': 'layered', 'elk.edgeRouting': 'ORTHOGONAL' },
}
