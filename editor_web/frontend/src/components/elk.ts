/** The layout engine in its worker; both are loaded when the first graph is drawn. */
import type { ElkShape, LayoutCall } from '../document/layout'

let engine: Promise<LayoutCall> | undefined
const answers = new Map<string, Promise<ElkShape>>()
/** So many graphs are remembered: those of a large behavior in several widths. */
const KEPT = 600

/** Lay out one graph in the worker; what was laid out before is known. */
export const layOutByElk: LayoutCall = (graph) => {
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
