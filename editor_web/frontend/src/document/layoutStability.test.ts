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

/** What arrows pass above or below may go up or down within its row; its neighbors there stay the same. */
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

  it('moves nothing before a container that is collapsed', async () => {
    const names = await moved(folded(before, new Set(['root/inner'])), before)
    expect(names.filter((name) => name.startsWith('s'))).toEqual([])
  })
})

const ORDERS = [
  { what: 'a straight machine', more: [] },
  { what: 'one whose loops are entered at one place', more: [to('s3', 'missed', 's1'), to('s1', 'none', 's4'), to('t1', 'bad', 's0')] },
]

it.each(ORDERS)('leaves $what where it is when the document names its states in another order', async ({ more }) => {
  const before = machine('root', children, more)
  const [one, other] = [await laidOut(before), await laidOut({ ...before, children: children.toReversed() })]
  const paths = children.map(({ path }) => path)
  expect(paths.map((path) => at(other, path))).toEqual(paths.map((path) => at(one, path)))
})

it('moves nothing above a row that gets one more state', async () => {
  const before = await laidOut(machine('root', states('root', 20)))
  const after = await laidOut(machine('root', [...states('root', 17), node('root/new'), ...states('root', 20).slice(17)]))
  const still = states('root', 17).map(({ path }) => path)
  expect(still.map((path) => at(after, path))).toEqual(still.map((path) => at(before, path)))
})

it.each(['RIGHT', 'DOWN'] as const)('stands what follows the first outcome before what follows the others, %s', async (direction) => {
  const names = ['d', 'c', 'b', 'a']
  const transitions = [to('a', 'seen', 'b'), to('a', 'none', 'c'), to('b', 'done', 'd'), to('c', 'done', 'd'), to('d', 'again', 'a')]
  const row = names.map((name) => node(`root/${name}`))
  const root = { ...machine('root', row), transitions, outcomes: [], initial: 'a' }
  const { boxes } = await layOut(root, { direction, rowLimit: Infinity }, byElk)
  const [a, b, c, d] = names.toReversed().map((name) => boxes.get(`root/${name}`) ?? { x: NaN, y: NaN })
  const [along, across] = direction === 'RIGHT' ? (['x', 'y'] as const) : (['y', 'x'] as const)
  expect([a, b, d].map((box) => box?.[along])).toEqual([a, b, d].map((box) => box?.[along] ?? NaN).toSorted((one, other) => one - other))
  expect(b?.[along]).toBe(c?.[along])
  expect(b?.[across]).toBeLessThan(c?.[across] ?? NaN)
})

/** A machine that branches and loops at random, the same for each seed: mostly a chain, with transitions to anywhere. */
class RandomMachine {
  readonly names: readonly string[]
  readonly transitions: readonly GraphTransition[]

  constructor(private seed: number) {
    this.names = Array.from({ length: 5 + this.below(7) }, (_, index) => `s${index}`)
    this.transitions = this.names.flatMap((source, index) => [
      to(source, 'done', this.below(6) === 0 ? this.name() : (this.names[index + 1] ?? 'finished')),
      ...Array.from({ length: this.below(3) }, (_, more) => to(source, `other${more}`, this.name())),
    ])
  }

  /** A whole number from 0 to below `most`. */
  below(most: number): number {
    this.seed = (Math.imul(this.seed, 1_103_515_245) + 12_345) & 0x7fffffff
    return (this.seed >>> 8) % most
  }

  name(): string {
    return this.names[this.below(this.names.length)] ?? ''
  }
}

/** As the server draws it: the transitions in the order of the states. One long row: how it is broken moves nothing in it. */
function inOneRow(names: readonly string[], transitions: readonly GraphTransition[]): Promise<Layout> {
  const root = machine(
    'root',
    names.map((name) => node(`root/${name}`)),
  )
  const ordered = names.flatMap((name) => transitions.filter(({ source }) => source === name))
  return layOut({ ...root, outcomes: ['finished'], transitions: ordered }, { direction: 'RIGHT', rowLimit: Infinity }, byElk)
}

/** Which of two states stands before or above the other. */
function orderOf(layout: Layout, one: string, other: string): string {
  const [a, b] = [layout.boxes.get(`root/${one}`), layout.boxes.get(`root/${other}`)]
  if (!a || !b) return 'not drawn'
  if (a.x + a.width <= b.x) return 'before'
  if (b.x + b.width <= a.x) return 'behind'
  return a.y < b.y ? 'above' : 'below'
}

/** The order of all pairs of these states. */
function ordersOf(layout: Layout, names: readonly string[]): readonly string[] {
  return names.flatMap((one, index) => names.slice(index + 1).map((other) => `${one} ${orderOf(layout, one, other)} ${other}`))
}

/** A state, and all that stand behind it because it leads to them. */
function from(layout: Layout, transitions: readonly GraphTransition[], start: string): ReadonlySet<string> {
  const found = new Set([start])
  for (const name of found) {
    for (const { source, target } of transitions) {
      if (source === name && orderOf(layout, source, target) === 'before') found.add(target)
    }
  }
  return found
}

describe.each(Array.from({ length: 8 }, (_, index) => index + 1))('a machine at random, number %i', (seed) => {
  const made = new RandomMachine(seed * 7919)
  const { names, transitions } = made

  it('has the same order beside and before a state that is added at its end', async () => {
    const more = [...transitions, to(made.name(), 'added', 'new'), to('new', 'done', made.name())]
    const [before, after] = [await inOneRow(names, transitions), await inOneRow([...names, 'new'], more)]
    const moved = from(after, more, 'new')
    const others = names.filter((name) => !moved.has(name))
    expect(ordersOf(after, others)).toEqual(ordersOf(before, others))
  })

  it('has the same order beside and before what a transition is added to', async () => {
    const [source, target] = [made.name(), made.name()]
    const more = [...transitions, to(source, 'added', target)]
    const [before, after] = [await inOneRow(names, transitions), await inOneRow(names, more)]
    const moved = from(after, more, target)
    const others = names.filter((name) => !moved.has(name))
    expect(ordersOf(after, others)).toEqual(ordersOf(before, others))
  })

  it('has the same order where a transition is added that leads back', async () => {
    const before = await inOneRow(names, transitions)
    // What nothing has led to would be read elsewhere once something does.
    const reached = [...from(before, transitions, names[0] ?? '')]
    const loops = reached.flatMap((target) =>
      [...from(before, transitions, target)].filter((source) => source !== target).map((source) => to(source, 'again', target)),
    )
    const loop = loops[made.below(loops.length)]
    const after = await inOneRow(names, [...transitions, ...(loop ? [loop] : [])])
    expect(ordersOf(after, names)).toEqual(ordersOf(before, names))
  })

  it('has the same order where a state gets another name', async () => {
    const old = made.name()
    const renamed = (name: string) => (name === old ? 'a_longer_name_than_before' : name)
    const others = names.map(renamed)
    const more = transitions.map(({ source, outcome, target }) => to(renamed(source), outcome, renamed(target)))
    const [before, after] = [await inOneRow(names, transitions), await inOneRow(others, more)]
    expect(ordersOf(after, others)).toEqual(ordersOf(before, names).map((each) => each.split(' ').map(renamed).join(' ')))
  })
})

function at(layout: Layout, path: string) {
  const box = layout.boxes.get(path)
  return { x: box?.x ?? NaN, y: box?.y ?? NaN }
}
