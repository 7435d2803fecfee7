/** The layout engine in its worker; both are loaded when the first graph is drawn. */
import type { LayoutCall } from '../document/layout'

let engine: Promise<LayoutCall> | undefined

/** Return elk's layout function, loading it on first use. */
export function loadElk(): Promise<LayoutCall> {
  engine ??= start()
  return engine
}

async function start(): Promise<LayoutCall> {
  const [{ default: Elk }, { default: ElkWorker }] = await Promise.all([
    import('elkjs/lib/elk-api.js'),
    import('elkjs/lib/elk-worker.min.js?worker'),
  ])
  const elk = new Elk({ workerFactory: () => new ElkWorker() })
  return ((graph) => elk.layout(graph as Parameters<typeof elk.layout>[0])) as LayoutCall
}
