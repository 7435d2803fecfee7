/** A layout is told by the behavior alone: a change moves what follows it, and nothing else. */
import Elk from 'elkjs/lib/elk.bundled.js'
import { describe, expect, it } from 'vitest'
import type { GraphNode, GraphTransition } from '../api/types'
import { folded } from './folding'
import type { LayoutCall } from './elkGraph'
import { layOut, type Layout } from './layout'
import { rowLimitFor } from './rows'
import { flatten } from './tree'

const elk = new Elk()
const byElk: LayoutCall = (graph) => elk.layout(graph as Parameters<typeof elk.layout>[0]) as ReturnType<LayoutCall>

/** As the page lays a behavior out, of which `root` is drawn. */
function laidOut(root: GraphNode, whole = root): Promise<Layout> {
  return layOut(root, { direction: 'RIGHT', rowLimit: rowLimitFor(flatten(whole).length) }, byElk)
}

function node(path: string, told: Partial<GraphNode> = {}): GraphNode {
  const name = path.split('/').at(-1) ?? path
  const none = { title: 'motion.MoveJoints', description: '', outcomes: ['done'], children: [], transitions: [], conditions: [] }
  return { path, name, kind: 'state', icon: 'path', ...none, initial: null, disabled: false, ...told }
}

function machine(path: string, children: readonly GraphNode[], more: readonly GraphTransition[] = []): GraphNode {
  const names = children.map((child) => child.name)
  const transitions = names.map((source, index) => ({ source, outcome: 'done', target: names[index + 1] ?? 'finished' }))
  return node(path, { kind: 'machine', title: '', children, transitions: [...transitions, ...more], initial: names[0] ?? null })
}

const to = (source: string, outcome: string, target: string): GraphTransition => ({ source, outcome, target })
const states = (path: string, count: number) => Array.from({ length: count }, (_, index) => node(`${path}/s${index}`))
const inner = machine('root/inner', states('root/inner', 5))
const children = [...states('root', 5), inner, ...['t0', 't1', 't2'].map((name) => node(`root/${name}`))]

/** Where the arrows of a loop pass above or below others, a state may go up or down within its row. */
const LOOPS = [to('s3', 'missed', 's1'), to('s1', 'none', 's4'), to('t1', 'bad', 's3')]

const CASES = [
  { what: 'a straight machine', more: [], sideways: false },
  { what: 'one that branches and comes back', more: LOOPS, sideways: true },
]

describe.each(CASES)('$what', ({ more, sideways }) => {
  const before = machine('root', children, more)
  const beforeIsLaidOut = laidOut(before)

  async function moved(after: GraphNode, whole = after): Promise<readonly string[]> {
    const [a, b] = [await beforeIsLaidOut, await laidOut(after, whole)]
    const isStill = (path: string) => at(a, path).x === at(b, path).x && (sideways || at(a, path).y === at(b, path).y)
    return before.children.filter(({ path }) => !isStill(path)).map(({ name }) => name)
  }

  it('stays where it is when a state is added at its end', async () => {
    expect(await moved(machine('root', [...children, node('root/last')], more))).toEqual([])
  })

  it('stays where it is when a state is added that nothing leads to yet', async () => {
    expect(await moved({ ...before, children: [node('root/loose'), ...children] })).toEqual([])
  })

  it('stays where it is when a state gets another name that is about as long', async () => {
    const after = machine('root', [...children.slice(0, 6), node('root/turn'), ...children.slice(7)], more)
    expect(await moved(after)).toEqual(['t0'])
  })

  it('stays where it is when the document names its states in another order', async () => {
    expect(await moved({ ...before, children: children.toReversed() })).toEqual([])
  })

  it('moves nothing before a container that is collapsed', async () => {
    const names = await moved(folded(before, new Set(['root/inner'])), before)
    expect(names.filter((name) => name.startsWith('s'))).toEqual([])
  })
})

it('moves nothing above a row that gets one more state', async () => {
  const before = await laidOut(machine('root', states('root', 20)))
  const after = await laidOut(machine('root', [...states('root', 17), node('root/new'), ...states('root', 20).slice(17)]))
  const still = states('root', 17).map(({ path }) => path)
  expect(still.map((path) => at(after, path))).toEqual(still.map((path) => at(before, path)))
})

function at(layout: Layout, path: string) {
  const box = layout.boxes.get(path)
  return { x: box?.x ?? NaN, y: box?.y ?? NaN }
}
