/** A selection is laid out around where it is, and what is not selected neither moves nor is covered. */
import Elk from 'elkjs/lib/elk.bundled.js'
import { describe, expect, it } from 'vitest'
import type { LayoutCall } from '../elkGraph'
import type { Box, Point } from '../geometry'
import { arrange } from './arrange'
import type { EditNode } from './model'
import { layOutChosen } from './selectionLayout'
import { machineNode, node } from './testNodes'

type Arrow = readonly [string, string, string]

const elk = new Elk()
const call: LayoutCall = (graph) => elk.layout(graph as Parameters<typeof elk.layout>[0]) as ReturnType<LayoutCall>
const ROW = 1200

function machineOf(arrows: readonly Arrow[], loose: readonly string[] = []): EditNode {
  const names = [...new Set(arrows.map(([source]) => source)), ...loose]
  const outcomes = (name: string) => arrows.filter(([source]) => source === name).map(([, outcome]) => outcome)
  const children = names.map((name) => node(`root/${name}`, outcomes(name)))
  return machineNode('root', names[0] ?? '', children, arrows)
}

/** The machine with its nodes at these places, and how it is drawn then. */
async function putAt(machine: EditNode, places: ReadonlyMap<string, Point>): Promise<ReadonlyMap<string, Box>> {
  const children = machine.children.map((child) => {
    const place = places.get(child.path)
    return place ? { ...child, position: [place.x, place.y] as const } : child
  })
  const { boxes } = await arrange({ ...machine, children }, { isOpen: () => true, declared: () => [], rowLimit: ROW, call })
  return new Map(children.flatMap(({ path }): [string, Box][] => (boxes.has(path) ? [[path, boxes.get(path) as Box]] : [])))
}

async function laidOut(machine: EditNode, chosen: readonly string[], boxes: ReadonlyMap<string, Box>, others: readonly Box[] = []) {
  const paths = new Set(chosen.map((name) => `root/${name}`))
  const corners = await layOutChosen(machine, paths, { boxes, others }, { rowLimit: ROW, call })
  expect([...corners.keys()].filter((path) => !paths.has(path))).toEqual([])
  return new Map([...boxes].map(([path, box]): [string, Box] => [path, { ...box, ...corners.get(path) }]))
}

function at(boxes: ReadonlyMap<string, Box>, name: string): Box {
  const box = boxes.get(`root/${name}`)
  if (!box) throw new Error(`${name} is not drawn`)
  return box
}

function middleOf(boxes: ReadonlyMap<string, Box>, names: readonly string[]): Point {
  const all = names.map((name) => at(boxes, name))
  const middle = (starts: readonly number[], ends: readonly number[]) => (Math.min(...starts) + Math.max(...ends)) / 2
  return {
    x: middle(
      all.map((box) => box.x),
      all.map((box) => box.x + box.width),
    ),
    y: middle(
      all.map((box) => box.y),
      all.map((box) => box.y + box.height),
    ),
  }
}

function areApart(a: Box, b: Box): boolean {
  return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y
}

/** The names of nodes that lie on one another, in pairs. */
function covered(boxes: ReadonlyMap<string, Box>): readonly string[] {
  const all = [...boxes]
  return all.flatMap(([path, box], index) =>
    all.slice(index + 1).flatMap(([other, below]) => (areApart(box, below) ? [] : [`${path} ${other}`])),
  )
}

const CHAIN = machineOf([
  ['a', 'done', 'b'],
  ['b', 'done', 'c'],
  ['c', 'done', 'd'],
  ['d', 'done', 'finished'],
])
const SCATTERED = new Map([
  ['root/a', { x: 0, y: 0 }],
  ['root/b', { x: 700, y: 900 }],
  ['root/c', { x: 560, y: 1010 }],
  ['root/d', { x: 590, y: 840 }],
])

it('puts what is selected in a row, with its middle where it was', async () => {
  const before = await putAt(CHAIN, SCATTERED)
  const after = await laidOut(CHAIN, ['b', 'c', 'd'], before)
  expect([at(after, 'b').y, at(after, 'c').y]).toEqual([at(after, 'd').y, at(after, 'd').y])
  expect(at(after, 'b').x + at(after, 'b').width).toBeLessThan(at(after, 'c').x)
  expect(at(after, 'c').x + at(after, 'c').width).toBeLessThan(at(after, 'd').x)
  const [was, is] = [before, after].map((boxes) => middleOf(boxes, ['b', 'c', 'd']))
  expect(Math.hypot((is?.x ?? NaN) - (was?.x ?? NaN), (is?.y ?? NaN) - (was?.y ?? NaN))).toBeLessThan(2)
})

it('goes aside of what is not selected, no further than it must', async () => {
  const before = await putAt(CHAIN, new Map([...SCATTERED, ['root/a', { x: 600, y: 930 }]]))
  const after = await laidOut(CHAIN, ['b', 'c', 'd'], before)
  expect(covered(after)).toEqual([])
  const [a, b] = [at(after, 'a'), at(after, 'b')]
  expect([b.y + b.height + 26, a.y + a.height + 26]).toContain(b.y < a.y ? a.y : b.y)
})

it('leaves notes on the canvas uncovered', async () => {
  const before = await putAt(CHAIN, SCATTERED)
  const note = { x: 500, y: 900, width: 400, height: 90 }
  const after = await laidOut(CHAIN, ['b', 'c', 'd'], before, [note])
  expect(['b', 'c', 'd'].filter((name) => !areApart(at(after, name), note))).toEqual([])
})

it('stays in rows as narrow as the room between others, where longer ones would go further away', async () => {
  const column = new Map(['b', 'c', 'd'].map((name, index) => [`root/${name}`, { x: 400 + 10 * index, y: 150 * index }]))
  const walls = [0, 700].map((x) => ({ x, y: -2000, width: 300, height: 4000 }))
  const before = await putAt(CHAIN, new Map([...column, ['root/a', { x: 0, y: 3000 }]]))
  const after = await laidOut(CHAIN, ['b', 'c', 'd'], before, walls)
  expect(new Set(['b', 'c', 'd'].map((name) => at(after, name).x)).size).toBe(1)
  expect(at(after, 'b').y).toBeLessThan(at(after, 'c').y)
  expect(Math.abs(at(after, 'b').x - 410)).toBeLessThan(20)
})

it('stands what a node leads to behind it, one above the other as in the whole machine', async () => {
  const machine = machineOf([
    ['start', 'done', 'choose'],
    ['choose', 'left', 'l'],
    ['choose', 'right', 'r'],
    ['l', 'done', 'end'],
    ['r', 'done', 'end'],
    ['end', 'again', 'choose'],
  ])
  const names = machine.children.map(({ name }) => name)
  const before = await putAt(machine, new Map(names.map((name, index) => [`root/${name}`, { x: 40 * index, y: 300 - 50 * index }])))
  const after = await laidOut(machine, names.slice(1), before)
  expect(covered(after)).toEqual([])
  expect(at(after, 'l').x).toBe(at(after, 'r').x)
  expect(at(after, 'l').y).toBeLessThan(at(after, 'r').y)
  expect(at(after, 'choose').x).toBeLessThan(at(after, 'l').x)
  expect(at(after, 'r').x).toBeLessThan(at(after, 'end').x)
})

it('puts the branches of one node in a column, though no transition leads from one to another', async () => {
  const machine = machineOf([
    ['choose', 'one', 'a'],
    ['choose', 'two', 'b'],
    ['choose', 'three', 'c'],
    ['a', 'done', 'finished'],
    ['b', 'done', 'finished'],
    ['c', 'done', 'finished'],
  ])
  const before = await putAt(
    machine,
    new Map(machine.children.map(({ path }, index) => [path, { x: 600 + 90 * index, y: 80 - 9 * index }])),
  )
  const after = await laidOut(machine, ['a', 'b', 'c'], before)
  expect(new Set(['a', 'b', 'c'].map((name) => at(after, name).x)).size).toBe(1)
  expect([at(after, 'a').y, at(after, 'b').y, at(after, 'c').y]).toEqual(
    [at(after, 'a').y, at(after, 'b').y, at(after, 'c').y].toSorted((one, other) => one - other),
  )
  expect(covered(after)).toEqual([])
})

it('lays out what no transition leads to', async () => {
  const machine = machineOf([['a', 'done', 'finished']], ['x', 'y', 'z'])
  const before = await putAt(machine, new Map(machine.children.map(({ path }, index) => [path, { x: 9 * index, y: 400 + 5 * index }])))
  const after = await laidOut(machine, ['x', 'y', 'z'], before)
  expect(covered(after).filter((pair) => !pair.startsWith('root/a '))).toEqual([])
})

/** Whole numbers at random, the same for each seed. */
function randomOf(seed: number): (most: number) => number {
  let state = seed
  return (most) => {
    state = (Math.imul(state, 1_103_515_245) + 12_345) & 0x7fffffff
    return (state >>> 8) % most
  }
}

describe.each(Array.from({ length: 12 }, (_, index) => index + 1))('a machine at random, number %i', (seed) => {
  const below = randomOf(seed * 104_729)
  const names = Array.from({ length: 6 + below(8) }, (_, index) => `s${index}`)
  const any = () => names[below(names.length)] ?? ''
  const machine = machineOf(
    names.flatMap((name, index): Arrow[] => [
      [name, 'done', names[index + 1] ?? 'finished'],
      ...Array.from({ length: below(3) }, (_, more): Arrow => [name, `other${more}`, any()]),
    ]),
  )
  const chosen = names.filter(() => below(2) === 0).concat(names.slice(0, 2))
  const selected = [...new Set(chosen)]
  const scattered = new Map(names.map((name) => [`root/${name}`, { x: below(1500), y: below(900) }]))

  it('covers nothing with what is selected, which stays as it is when it is laid out again', async () => {
    const before = await putAt(machine, scattered)
    const ours = selected.map((name) => `root/${name}`)
    const after = await laidOut(machine, selected, before)
    expect(covered(after).filter((pair) => ours.some((path) => pair.split(' ').includes(path)))).toEqual([])
    const again = await laidOut(machine, selected, new Map([...after].map(([path, box]) => [path, rounded(box)])))
    expect(ours.map((path) => rounded(again.get(path) as Box))).toEqual(ours.map((path) => rounded(after.get(path) as Box)))
  })
})

function rounded(box: Box): Box {
  return { ...box, x: Math.round(box.x), y: Math.round(box.y) }
}
