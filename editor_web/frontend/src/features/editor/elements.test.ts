/** The canvas's nodes after an edit: those that it leaves alone are the objects of before, all of them as if drawn anew. */
import { expect, it } from 'vitest'
import type { DocumentNode } from '../../api/types'
import lines from '../../../testing/optimistic_edits.jsonl?raw'
import { outcomeId } from '../../document/edgeId'
import type { Edit } from '../../document/editing/edits'
import { allNodes, nodeOf, withNode, type EditNode } from '../../document/editing/model'
import { withEdits } from '../../document/editing/optimisticEdits'
import { canvasNodes, type DrawnInput, type KeptCards } from './elements'

const [first, ...others] = lines.trim().split('\n')
const graph = JSON.parse(first ?? '') as DocumentNode
const edited = others.flatMap((line) => {
  const { edits } = JSON.parse(line) as { readonly edits: readonly Edit[] }
  return withEdits(graph, edits) ?? []
})

const BOX = { x: 3, y: 5, width: 120, height: 40 }

function drawn(root: EditNode, more: Partial<DrawnInput> = {}): DrawnInput {
  const nodes = allNodes(root)
  const outcomes = nodes.flatMap((node) => node.outcomes.map((outcome) => outcomeId(node.path, outcome)))
  const boxes = new Map([...nodes.map((node) => node.path), ...outcomes].map((id) => [id, BOX]))
  const arrangement = { boxes, routes: new Map(), origins: new Map() } as unknown as DrawnInput['arrangement']
  return { root, scope: root, arrangement, isOpen: () => true, declared: () => [], ...more }
}

it('draws the same after each edit with what it kept as without', () => {
  expect(edited.length).toBeGreaterThan(60)
  const kept: KeptCards = new WeakMap()
  for (const after of edited) {
    for (const root of [graph, after]) expect(canvasNodes(drawn(root), kept)).toEqual(canvasNodes(drawn(root)))
  }
})

it('keeps the card of what an edit leaves alone', () => {
  const kept: KeptCards = new WeakMap()
  const before = canvasNodes(drawn(graph), kept)
  const after = canvasNodes(drawn(withEdits(graph, [{ edit: 'duplicate', paths: ['root/inside/one'] }]) ?? graph), kept)
  const same = new Set(after.filter((each) => before.includes(each)).map((each) => each.id))
  expect(same).toContain('root/both/left')
  expect(same).not.toContain('root/inside/two')
  expect(same).not.toContain('root/look')
})

it('draws a node anew when something far around it is disabled or of another kind, when it is closed, and when it is put elsewhere', () => {
  const kept: KeptCards = new WeakMap()
  canvasNodes(drawn(graph), kept)
  const inside = nodeOf(graph, 'root/inside')
  const changed = (path: string, change: Partial<EditNode>): EditNode => {
    const now = nodeOf(graph, path)
    return now ? withNode(graph, path, { ...now, ...change }) : graph
  }
  const roots = [
    changed('root/inside', { disabled: true }),
    changed('root/inside', { kind: 'behavior' }),
    changed('root/branch/sequence', { kind: 'machine' }),
  ]
  const shut = { isOpen: (path: string) => path !== 'root/inside' }
  const boxes = new Map([...drawn(graph).arrangement.boxes].map(([id, box]) => [id, { ...box, x: 9 }]))
  const elsewhere = { arrangement: { ...drawn(graph).arrangement, boxes } }
  const scope = { scope: inside ?? graph }
  for (const input of [
    ...roots.map((root) => drawn(root)),
    drawn(graph, shut),
    drawn(graph, elsewhere),
    drawn(graph, scope),
    drawn(graph),
  ]) {
    expect(canvasNodes(input, kept)).toEqual(canvasNodes(input))
  }
})
