/** How large each node of the editor's canvas is, and where its ports are. Pure. */
import { isMachine, outgoingTransitions, type EditNode } from './model'
import type { Size } from '../geometry'
import { widthFrom } from '../rows'

const HEAD_HEIGHT = 48
export const FRAME_HEAD = 40
const ROW_HEIGHT = 22
export const RULE_HEIGHT = 22
export const PILL_HEIGHT = 28
const TWIG_HEIGHT = 40
/** Line and space above the rows. */
const ROWS_TOP = 3.5
/** Cards are as wide as one of these, so that a longer name seldom moves what is beside them. */
const WIDTHS = [172, 204, 236, 268, 300] as const

function textWidth(text: string, perCharacter: number): number {
  return Math.ceil(text.length * perCharacter)
}

/** The words beside a port whose arrow is not drawn: `failed → lost`. */
function transitionText(outcome: string, target: string | undefined): string {
  return target === undefined || target === outcome ? outcome : `${outcome} → ${target}`
}

/** Height of the rows with the ports. */
export function rowsHeight(count: number): number {
  return count > 0 ? count * ROW_HEIGHT + 7 : 0
}

/** A state, or a container that is closed. */
export function leafSize(node: EditNode, parent: EditNode | undefined): Size {
  const outgoing = outgoingTransitions(parent, node)
  const rows = outgoing.map((each) => textWidth(transitionText(each.outcome, each.target), 6.4) + 44)
  const widest = Math.max(textWidth(node.name, 8.2) + 62, textWidth(node.title, 6.9) + 46, ...rows)
  return {
    width: widthFrom(WIDTHS, widest),
    height: outgoing.length > 0 ? HEAD_HEIGHT + rowsHeight(outgoing.length) : HEAD_HEIGHT + 6,
  }
}

/** A part of a tree that holds others. */
export function twigSize(node: EditNode): Size {
  return { width: Math.min(220, Math.max(112, textWidth(node.name, 7.6) + 62)), height: TWIG_HEIGHT }
}

/** The least width of an open container: what its head says. */
export function frameWidth(node: EditNode): number {
  return textWidth(node.name, 8.6) + 190
}

export function pillWidth(outcome: string): number {
  return textWidth(outcome, 7) + 40
}

/** The rules of a concurrency container as a table: its head and a line for each. */
export function tableHeight(node: EditNode): number {
  return node.kind === 'concurrency' ? (Math.max(1, node.rules.length + (node.otherwise ? 1 : 0)) + 1) * RULE_HEIGHT + 10 : 0
}

/** Where the port of the `index`-th outcome is, from the top of a node of this height with `count` of them. */
export function portY(height: number, count: number, index: number): number {
  return height - rowsHeight(count) + ROWS_TOP + index * ROW_HEIGHT + ROW_HEIGHT / 2
}

/** Where arrows come in, from the top of a node: at the height of its first outcome, so that what follows one another is one line. */
export function entryY(height: number, outgoing: number): number {
  return outgoing > 0 ? portY(height, outgoing, 0) : Math.min(height / 2, HEAD_HEIGHT / 2)
}

/** The outcomes of a machine as places that arrows can lead to, and which of them stand in the flow. */
export function pillsOf(
  node: EditNode,
  declared: readonly string[],
): { readonly drawn: readonly string[]; readonly gathered: readonly string[] } {
  if (!isMachine(node.kind)) return { drawn: [], gathered: [] }
  const inside = new Set(node.children.map((child) => child.name))
  const all = [...new Set([...node.outcomes, ...declared])].filter((outcome) => !inside.has(outcome))
  const drawn = all.filter((outcome) => node.transitions.filter((t) => t.target === outcome).length === 1)
  return { drawn, gathered: all.filter((outcome) => !drawn.includes(outcome)) }
}
