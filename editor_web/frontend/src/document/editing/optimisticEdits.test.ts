/** What the page shows before the server has answered, against what the server answers: examples made by the server. */
import { expect, test } from 'vitest'
import type { DocumentNode, GraphDifference } from '../../api/types'
import lines from '../../../testing/optimistic_edits.jsonl?raw'
import type { Edit } from './edits'
import { withDifference } from './graphDifference'
import { withEdits } from './optimisticEdits'
import type { EditNode } from './model'

interface Example {
  readonly edits: readonly Edit[]
  readonly difference: GraphDifference | null
}

const [first, ...others] = lines.trim().split('\n')
const graph = JSON.parse(first ?? '') as DocumentNode
const examples = others.map((line) => JSON.parse(line) as Example)

/** A node without its lines: they are those of a text that does not exist yet. */
function unlined(node: EditNode): EditNode {
  return { ...node, line: 0, column: 0, end_line: 0, children: node.children.map(unlined) }
}

/** An edit and what it is of. */
function inWords({ edit, ...of }: Edit): string {
  return [edit, ...Object.values(of).flat()].join(' ')
}

function answered({ difference }: Example): EditNode | undefined {
  return difference ? withDifference(graph, difference) : undefined
}

test('what is shown meanwhile is what the server then answers', () => {
  const pairs = examples.flatMap((example) => {
    const [shown, answer] = [withEdits(graph, example.edits), answered(example)]
    return shown && answer ? [{ edits: example.edits, shown: unlined(shown), answer: unlined(answer) }] : []
  })
  expect(pairs.length).toBeGreaterThan(60)
  for (const { edits, shown, answer } of pairs) expect({ edits, graph: shown }).toEqual({ edits, graph: answer })
})

test('what the server refuses is not shown', () => {
  const shown = examples.filter((example) => !example.difference && withEdits(graph, example.edits) !== undefined)
  expect(shown.map((example) => example.edits)).toEqual([])
})

const LEFT = [
  'remove_nodes root/look',
  'remove_nodes root/wait',
  'set_transition root/inside/one a good',
  'set_transition root/inside/one b good',
  'remove_nodes root/inside/two',
  'set_transition root/inside/two more good',
  'set_transition root/inside/three over good',
  'remove_nodes root/inside/three/first',
  'set_transition root/inside/three/first more good',
  'clear_transition root/inside/three/first full',
  'set_transition root/inside/three/first full first',
  'set_transition root/inside/three/first full good',
  'remove_nodes root/both/left',
  'rename_node root/both/left other',
  'remove_nodes root/both/right',
  'rename_node root/both/right other',
  'remove_nodes root/branch/sequence',
  'rename_node root/branch/sequence other',
  'duplicate root/branch/sequence/Give',
  'remove_nodes root/branch/sequence/Give',
  'rename_node root/branch/sequence/Give other',
  'duplicate root/branch/sequence/selector',
  'remove_nodes root/branch/sequence/selector',
  'rename_node root/branch/sequence/selector other',
  'duplicate root/branch/sequence/selector/Count',
  'remove_nodes root/branch/sequence/selector/Count',
  'rename_node root/branch/sequence/selector/Count other',
  'duplicate root/branch/sequence/selector/Count_2',
  'remove_nodes root/branch/sequence/selector/Count_2',
  'rename_node root/branch/sequence/selector/Count_2 other',
  'set_transition root/alone unknown look',
]

test('all is shown at once but what changes the outcomes of a container, or the names inside a tree', () => {
  const left = examples.filter((example) => example.difference && withEdits(graph, example.edits) === undefined)
  expect(left.flatMap((example) => example.edits.map(inWords))).toEqual(LEFT)
})

test('nodes that do not change stay the same objects', () => {
  const shown = withEdits(graph, [{ edit: 'duplicate', paths: ['root/alone'] }])
  expect(shown?.children.slice(0, -1)).toEqual(graph.children)
  expect(shown?.children.slice(0, -1).every((child, index) => child === graph.children[index])).toBe(true)
})
