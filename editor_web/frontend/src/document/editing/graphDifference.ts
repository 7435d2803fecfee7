/** Turning the graph of a text into that of the text after an edit, with the difference that the server sends. Pure. */
import type { FindingView, GraphDifference } from '../../api/types'
import { lookup, type Dict } from '../dict'
import { allNodes, type EditNode } from './model'

type Shifts = GraphDifference['shifts']
type Transitions = EditNode['transitions']

/** Where a line of the old text is in the new one. */
function shiftedLine(line: number, shifts: Shifts): number {
  const last = shifts.findLast(([begin]) => begin <= line)
  return last ? line + last[1] : line
}

/**
 * The graph after an edit; nodes that do not change stay the same objects.
 * What is shown inside of a reference is not of this text: it stays with a reference that stays as it is.
 * Undefined where the difference is not one of this graph.
 */
export function withDifference(root: EditNode, difference: GraphDifference): EditNode | undefined {
  const known = new Map(allNodes(root).map((node) => [node.path, node]))
  const made = (path: string): EditNode | undefined => {
    const was = known.get(path)
    const own = lookup(difference.nodes, path) ?? was
    if (!own) return undefined
    const isReference = was?.kind === 'behavior'
    const names = lookup(difference.children, path) ?? (was && !isReference ? was.children.map((child) => child.name) : [])
    const children: EditNode[] = []
    for (const name of names) {
      const child = made(`${path}/${name}`)
      if (!child) return undefined
      children.push(child)
    }
    const [line, column, end_line] = linesOf(path, was, difference)
    const isPlace = was?.line === line && was.column === column && was.end_line === end_line
    if (own === was && isPlace && isReference) return was
    const arrows = lookup(difference.arrows, path)
    const isInside = was?.children.length === children.length && children.every((child, index) => child === was.children[index])
    if (own === was && isPlace && isInside && !arrows) return was
    const transitions = arrows || lookup(difference.children, path) ? transitionsOf(names, was, arrows) : (was?.transitions ?? [])
    return { ...own, line, column, end_line, children: isInside ? was.children : children, transitions }
  }
  return made(root.path)
}

function linesOf(path: string, was: EditNode | undefined, difference: GraphDifference): readonly [number, number, number] {
  const given = lookup(difference.lines, path)
  if (given || !was) return given ?? [1, 1, 1]
  return [shiftedLine(was.line, difference.shifts), was.column, shiftedLine(was.end_line, difference.shifts)]
}

/** The transitions between children, in the order of the children; those of before where nothing is said. */
function transitionsOf(names: readonly string[], was: EditNode | undefined, given: Dict<Transitions> | undefined): Transitions {
  const before = new Map<string, Transitions>()
  for (const arrow of was?.transitions ?? []) before.set(arrow.source, [...(before.get(arrow.source) ?? []), arrow])
  return names.flatMap((name) => lookup(given, name) ?? before.get(name) ?? [])
}

/** Findings of the old text at their lines in the new one. */
export function shiftedFindings(findings: readonly FindingView[], { shifts }: GraphDifference): readonly FindingView[] {
  if (shifts.length === 0) return findings
  return findings.map((each) => ({ ...each, line: shiftedLine(each.line, shifts) }))
}
