/** The document as the editor sees it: nodes with everything that can be edited, and where each stands in the text. Pure. */
import type { DocumentInfo, DocumentNode, FindingView } from '../../api/types'
import { parentPath, pathsTo } from '../path'

/** One node; what is inside a referenced behavior is drawn, not edited here. */
export type EditNode = DocumentNode

/** What is known of one text of the document. */
export interface Draft {
  readonly text: string
  /** The last graph that could be read; of an earlier text while `isStale`. */
  readonly root: EditNode | undefined
  /** The hash of the text that `root` was drawn from; empty where that is not known. */
  readonly hash: string
  /** Of an earlier text until `isChecked`. */
  readonly findings: readonly FindingView[]
  readonly isChecked: boolean
  /** Targets that an arm cannot be at; of an earlier text until `areTargetsKnown`. */
  readonly targets: readonly FindingView[]
  readonly areTargetsKnown: boolean
  /** True while the text cannot be read, so that `root` belongs to an earlier one. */
  readonly isStale: boolean
  /** What stands beside the nodes: name, parameters, outcomes; undefined until the text could be read once. */
  readonly document: DocumentInfo | undefined
}

export const ROOT = 'root'

/** All nodes, parents before children. */
export function allNodes(root: EditNode): readonly EditNode[] {
  return [root, ...root.children.flatMap(allNodes)]
}

/** The node at a path. */
export function nodeOf(root: EditNode | undefined, path: string): EditNode | undefined {
  let node = root
  if (!node || (path !== node.path && !path.startsWith(`${node.path}/`))) return undefined
  while (node && node.path !== path) {
    node = node.children.find((child) => path === child.path || path.startsWith(`${child.path}/`))
  }
  return node
}

/** The graph with another node at the path of one; nodes beside it stay the same objects. */
export function withNode(root: EditNode, path: string, by: EditNode): EditNode {
  if (root.path === path) return by
  const children = root.children.map((child) =>
    path === child.path || path.startsWith(`${child.path}/`) ? withNode(child, path, by) : child,
  )
  return { ...root, children }
}

/** All other kinds are trees and their parts. */
const OUTSIDE_TREES: ReadonlySet<string> = new Set(['', 'state', 'machine', 'concurrency', 'priority', 'foreach', 'behavior', 'behaviour'])
const COMPOSITES: ReadonlySet<string> = new Set(['sequence', 'selector', 'parallel'])

/** Parts whose children have roles, which say how many there may be. */
const MOST_CHILDREN: Readonly<Record<string, number>> = { if_then_else: 3, while_do_else: 3 }

/** Is its inside drawn as a tree of lines instead of a frame? */
export function isTreePart(kind: string): boolean {
  return !OUTSIDE_TREES.has(kind)
}

/** Can it have any number of children, in an order that means something? */
export function isComposite(kind: string): boolean {
  return COMPOSITES.has(kind)
}

/** Do its children follow one another along transitions? */
export function isMachine(kind: string): boolean {
  return kind === 'machine' || kind === 'priority'
}

const HOLDERS: ReadonlySet<string> = new Set(['machine', 'priority', 'concurrency', 'sequence', 'selector', 'parallel'])

/** Can its inside be shown, in place or by going into it? */
export function isFrame(node: EditNode): boolean {
  if (isMachine(node.kind) || node.kind === 'concurrency' || node.kind === 'tree' || node.kind === 'foreach') return true
  return !isTreePart(node.kind) && node.children.length > 0
}

/** Has it room for one more child? A behavior that is referred to is edited in its own file. */
export function isHolder(node: EditNode): boolean {
  if (HOLDERS.has(node.kind)) return true
  return (isTreePart(node.kind) || node.kind === 'foreach') && node.children.length < (MOST_CHILDREN[node.kind] ?? 1)
}

/** Is it inside a behavior that is referred to, and so not of this document? */
export function isForeign(root: EditNode, path: string): boolean {
  return pathsTo(path)
    .slice(0, -1)
    .some((above) => nodeOf(root, above)?.kind === 'behavior')
}

/** The container that an addition goes into when `path` is chosen: the node itself where it holds others, else its parent. */
export function holderOf(root: EditNode, path: string): EditNode | undefined {
  const node = nodeOf(root, path)
  if (!node || path === '') return undefined
  if (isHolder(node) && !isForeign(root, path)) return node
  return holderOf(root, parentPath(path))
}

/** A name that no child of `parent` has yet, nor one of its outcomes: `grasp`, `grasp_2`, …; as the server chooses it. */
export function freeName(parent: EditNode | undefined, preferred: string, others: Iterable<string> = []): string {
  const outcomes = parent && isMachine(parent.kind) ? [...parent.outcomes, ...Object.keys(parent.targets)] : []
  const taken = new Set([...(parent?.children.map((child) => child.name) ?? []), ...outcomes, ...others])
  const base =
    preferred
      .replace(/[^A-Za-z0-9_-]+/g, '_')
      .replace(/^-+/, '')
      .slice(0, 56) || 'node'
  if (!taken.has(base)) return base
  let number = 2
  while (taken.has(`${base}_${number}`)) number += 1
  return `${base}_${number}`
}

/** A name for a new node that runs `state`: `motion.MoveJoints` → `move_joints`. */
export function nameFor(state: string): string {
  const last = state.split(/[.:/]/).pop() ?? state
  return last.replace(/([a-z0-9])([A-Z])/g, '$1_$2').toLowerCase()
}

/** What stands in the way of a name, or nothing. */
export function nameProblem(parent: EditNode | undefined, name: string, present = ''): string | undefined {
  if (!/^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$/.test(name)) return 'Use letters, digits, _ and -, at most 64'
  if (name !== present && parent?.children.some((child) => child.name === name)) return `There is a ${name} already`
  return undefined
}

/** An outcome of a node, and where it leads; undefined where nothing is connected. */
export interface OutgoingTransition {
  readonly outcome: string
  readonly target: string | undefined
  /** An outcome of the node, or a timeout, guard or error that leads away. */
  readonly isOutcome: boolean
}

/** The outcomes of a child of a machine, its own outcomes first; none elsewhere. */
export function outgoingTransitions(parent: EditNode | undefined, node: EditNode): readonly OutgoingTransition[] {
  if (!parent || !isMachine(parent.kind)) return []
  const own = parent.transitions.filter((t) => t.source === node.name)
  const targets = new Map(own.map((t) => [t.outcome, t.target]))
  const outcomes = inOrder(node, own).map((outcome) => ({ outcome, target: targets.get(outcome), isOutcome: true }))
  const known = new Set(node.outcomes)
  const others = own.filter((t) => !known.has(t.outcome)).map((t) => ({ outcome: t.outcome, target: t.target, isOutcome: false }))
  return [...outcomes, ...others]
}

/** A state's outcomes as it declares them; those of a container as they are connected. */
function inOrder(node: EditNode, outgoing: readonly { readonly outcome: string }[]): readonly string[] {
  if (node.kind === 'state') return node.outcomes
  const connected = outgoing.map((each) => each.outcome).filter((outcome) => node.outcomes.includes(outcome))
  return [...new Set([...connected, ...node.outcomes])]
}

/** Does this outcome say that something went wrong? It is drawn apart. */
export function isFailure(outcome: string): boolean {
  return /fail|error|abort|missed|lost|broken/.test(outcome)
}
