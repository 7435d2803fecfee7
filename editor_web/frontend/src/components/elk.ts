/** The layout engine in its worker; both are loaded when the first graph is drawn, or ahead of a large one. */
import { anonymous } from '../document/anonymous'
import type { ElkShape, LayoutCall } from '../document/layout'

let engine: Promise<LayoutCall> | undefined
const answers = new Map<string, Promise<ElkShape>>()
/** So many graphs are remembered: those of a large behavior in several widths. */
const KEPT = 600

/** Lay out one graph in the worker; what was laid out before is known, also under other names. */
export const layOutByElk: LayoutCall = async (given) => {
  const { graph, named } = anonymous(given)
  return named(await answerTo(graph))
}

/** Load the engine and let it lay out a little, so that the first who needs it need not wait for that. */
export function warmUpElk(): void {
  if (engine) return
  const call = () => void layOutByElk(SMALL).catch(() => undefined)
  // Safari has no idle callbacks.
  if ('requestIdleCallback' in globalThis) requestIdleCallback(call)
  else setTimeout(call, 500)
}

function answerTo(graph: ElkShape): Promise<ElkShape> {
  const key = JSON.stringify(graph)
  const known = answers.get(key)
  if (known) return known
  engine ??= start()
  const answer = engine.then((call) => call(graph))
  answers.set(key, answer)
  answer.catch(() => answers.delete(key))
  const oldest = answers.size > KEPT ? answers.keys().next().value : undefined
  if (oldest !== undefined) answers.delete(oldest)
  return answer
}

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
