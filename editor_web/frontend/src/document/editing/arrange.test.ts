/** Where things go on the editor's canvas. */
import { expect, it } from 'vitest'
import { arrange, rulesId } from './arrange'
import { freeName, holderOf, isForeign, nameFor, nodeOf, outgoingTransitions } from './model'
import { machineNode, node } from './testNodes'

const options = {
  isOpen: () => true,
  declared: () => [],
  rowLimit: 2000,
  call: () => Promise.reject(new Error('the engine was called')),
}

const chain = machineNode(
  'root',
  'a',
  [node('root/a', ['done', 'failed']), node('root/b', ['done', 'failed'])],
  [
    ['a', 'done', 'b'],
    ['b', 'done', 'finished'],
    ['a', 'failed', 'failed'],
    ['b', 'failed', 'failed'],
  ],
)

it('lays a chain out in a row, from port to head, and gathers what many lead to below', async () => {
  const { boxes, routes } = await arrange(chain, options)
  const [a, b, finished, failed] = ['root/a', 'root/b', 'root#finished', 'root#failed'].map((id) => boxes.get(id))
  expect(a && b && a.x + a.width).toBeLessThan(b?.x ?? 0)
  expect(finished?.x).toBeGreaterThan((b?.x ?? 0) + (b?.width ?? 0))
  expect(failed?.y).toBeGreaterThan((a?.y ?? 0) + (a?.height ?? 0))
  expect([...routes.keys()]).toEqual(['root|a|done', 'root|b|done'])
  expect(routes.get('root|a|done')?.[0]).toMatchObject({ x: (a?.x ?? 0) + (a?.width ?? 0) })
})

it('leaves children where they were put, and puts new ones below', async () => {
  const moved = { ...chain, children: [node('root/a', ['done'], { position: [400, 90] }), node('root/b', ['done'])] }
  const { boxes, routes } = await arrange(moved, options)
  expect(boxes.get('root/a')).toMatchObject({ x: 400, y: 90 })
  expect(boxes.get('root/b')?.y).toBeGreaterThan(90)
  expect(routes.size).toBe(0)
})

it('keeps the inside of an open container in its frame, in its upper corner', async () => {
  const inner = machineNode('root/in', 'a', [node('root/in/a', ['done'], { position: [-300, 700] })], [])
  const root = machineNode('root', 'in', [inner], [])
  const { boxes, origins } = await arrange(root, options)
  const frame = boxes.get('root/in')
  const child = boxes.get('root/in/a')
  expect(child?.x).toBeGreaterThan(0)
  expect(child && frame && child.y + child.height).toBeLessThan(frame?.height ?? 0)
  const origin = origins.get('root/in') ?? { x: 0, y: 0 }
  expect({ x: -300 + origin.x, y: 700 + origin.y }).toEqual({ x: child?.x, y: child?.y })
})

it('draws a tree below its top, children in order, and a closed branch without its inside', async () => {
  const leaves = ['x', 'y', 'z'].map((name) => node(`root/sequence/${name}`, ['done']))
  const top = node('root/sequence', ['success', 'failure'], { kind: 'sequence', children: leaves })
  const root = node('root', ['success', 'failure'], { kind: 'tree', children: [top] })
  const { boxes } = await arrange(root, options)
  const xs = leaves.map((leaf) => boxes.get(leaf.path)?.x ?? NaN)
  expect(xs).toEqual(xs.toSorted((p, q) => p - q))
  expect(boxes.get('root/sequence/x')?.y).toBeGreaterThan(boxes.get('root/sequence')?.y ?? 0)
  const closed = await arrange(root, { ...options, isOpen: (path) => path !== 'root/sequence' })
  expect(closed.boxes.has('root/sequence/x')).toBe(false)
})

it('stacks what runs side by side, and shows the rules below', async () => {
  const root = node('root', ['both'], {
    kind: 'concurrency',
    children: [node('root/left', ['a']), node('root/right', ['a'])],
    rules: [{ outcome: 'both', when: { left: 'a', right: 'a' }, at_least: null, preempt: [] }],
  })
  const { boxes } = await arrange(root, options)
  expect(boxes.get('root/right')?.y).toBeGreaterThan(boxes.get('root/left')?.y ?? 0)
  expect(boxes.get(rulesId('root'))?.y).toBeGreaterThan(boxes.get('root/right')?.y ?? 0)
})

it('knows names, outcomes, holders and what belongs to another document', () => {
  expect(freeName(chain, 'a')).toBe('a_2')
  expect(freeName(chain, 'new one!')).toBe('new_one_')
  expect(nameFor('motion.MoveJoints')).toBe('move_joints')
  expect(outgoingTransitions(chain, nodeOf(chain, 'root/a') ?? chain).map((way) => [way.outcome, way.target])).toEqual([
    ['done', 'b'],
    ['failed', 'failed'],
  ])
  expect(holderOf(chain, 'root/a')?.path).toBe('root')
  const other = node('root/r', ['x'], {
    kind: 'behavior',
    children: [machineNode('root/r/root', 'q', [node('root/r/root/q', ['x'])], [])],
  })
  const root = machineNode('root', 'r', [other], [])
  expect(isForeign(root, 'root/r/root/q')).toBe(true)
  expect(isForeign(root, 'root/r')).toBe(false)
  expect(holderOf(root, 'root/r/root/q')?.path).toBe('root')
})
