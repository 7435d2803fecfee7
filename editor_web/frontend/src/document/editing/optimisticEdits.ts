/**
 * The graph after edits, before the server has written them: what the page shows meanwhile.
 *
 * Only what follows from the graph alone: an edit that gives or takes away an outcome of a container changes what is
 * around it too, and is left to the server. Lines and findings are those of the text before. Pure.
 */
import type { DuplicateNodes, RemoveNodes, RenameNode, SetInitial } from '../../api/types'
import { fieldsOf, lookup, without } from '../dict'
import { nameOfPath, parentPath } from '../path'
import type { Edit } from './edits'
import { areOfLayout, withLayout } from './layoutEdits'
import { freeName, isMachine, nodeOf, withNode, type EditNode } from './model'

/** A copy stands so far to the right of and below its original, as the server puts it. */
const COPY_STEP_PX = 40

type NewName = (target: string) => string

/** The graph after all edits; undefined where it does not follow from the graph before. */
export function withEdits(root: EditNode, edits: readonly Edit[]): EditNode | undefined {
  return edits.reduce<EditNode | undefined>((now, edit) => now && withEdit(now, edit), root)
}

function withEdit(root: EditNode, edit: Edit): EditNode | undefined {
  if (areOfLayout([edit])) return withLayout(root, [edit])
  switch (edit.edit) {
    case 'duplicate':
      return duplicated(root, edit)
    case 'remove_nodes':
      return removed(root, edit)
    case 'rename_node':
      return renamed(root, edit)
    case 'set_initial':
      return inMachine(root, edit.path, (machine) => begunWith(machine, edit))
    case 'set_transition':
      return withTargets(root, edit.path, (targets) => ({ ...targets, [edit.outcome]: edit.target }))
    case 'clear_transition':
      return withTargets(root, edit.path, (targets) =>
        lookup(targets, edit.outcome) === undefined ? undefined : without(targets, edit.outcome),
      )
    default:
      return undefined
  }
}

function duplicated(root: EditNode, { paths }: DuplicateNodes): EditNode | undefined {
  const home = soleParent(paths)
  return home === undefined
    ? undefined
    : inContainer(root, home, ['machine', 'priority', 'concurrency'], (holder) => copiedInside(holder, paths))
}

function copiedInside(holder: EditNode, paths: readonly string[]): EditNode | undefined {
  const originals = holder.children.filter((child) => paths.includes(child.path))
  if (originals.length !== paths.length) return undefined
  const names = new Map<string, string>()
  for (const path of paths) names.set(nameOfPath(path), freeName(holder, nameOfPath(path), names.values()))
  const newName: NewName = (target) => names.get(target) ?? target
  const copies = paths.flatMap((path) => {
    const original = nodeOf(holder, path)
    return original ? copyOf(original, `${holder.path}/${newName(original.name)}`, newName) : []
  })
  const last = Math.max(...originals.map((original) => holder.children.indexOf(original)))
  const children = [...holder.children.slice(0, last + 1), ...copies, ...holder.children.slice(last + 1)]
  const arrows = arrowsBySource(holder)
  for (const [name, copy] of names)
    arrows.set(
      copy,
      (arrows.get(name) ?? []).map((arrow) => ({ ...arrow, source: copy, target: newName(arrow.target) })),
    )
  const initial = isMachine(holder.kind) ? (holder.initial ?? children[0]?.name ?? null) : holder.initial
  return { ...holder, children, initial, transitions: children.flatMap((child) => arrows.get(child.name) ?? []) }
}

function copyOf(original: EditNode, path: string, newName: NewName): EditNode {
  const position = original.position && ([original.position[0] + COPY_STEP_PX, original.position[1] + COPY_STEP_PX] as const)
  const copy = retargeted(original, newName)
  return { ...withoutLayout(at(copy, path)), name: nameOfPath(path), label: nameOfPath(path), position }
}

/** A copy has neither the notes nor, inside, the positions of its original. */
function withoutLayout(node: EditNode): EditNode {
  return { ...node, position: null, notes: '', canvas_notes: {}, children: node.children.map(withoutLayout) }
}

/** The same node with all inside at another path. */
function at(node: EditNode, path: string): EditNode {
  return { ...node, path, children: node.children.map((child) => at(child, `${path}/${child.name}`)) }
}

function removed(root: EditNode, { paths }: RemoveNodes): EditNode | undefined {
  const home = soleParent(paths)
  return home === undefined ? undefined : inMachine(root, home, (machine) => emptied(machine, new Set(paths.map(nameOfPath))))
}

function emptied(machine: EditNode, gone: ReadonlySet<string>): EditNode | undefined {
  if ([...gone].some((name) => !machine.children.some((child) => child.name === name))) return undefined
  const kept = machine.children.filter((child) => !gone.has(child.name))
  // A timeout, guard or error that leads to what is removed goes on to lead there, to nothing.
  const isLeft = (arrow: EditNode['transitions'][number]): boolean => {
    const source = kept.find((child) => child.name === arrow.source)
    return source !== undefined && gone.has(arrow.target) && lookup(source.targets, arrow.outcome) === undefined
  }
  if (kept.length === 0 || machine.transitions.some(isLeft)) return undefined
  const children = kept.map((child) => {
    const left = Object.entries(child.targets).filter(([, target]) => !gone.has(target))
    return left.length === Object.keys(child.targets).length ? child : leading(child, Object.fromEntries(left))
  })
  const transitions = machine.transitions.filter((arrow) => !gone.has(arrow.source) && !gone.has(arrow.target))
  const initial = machine.initial !== null && gone.has(machine.initial) ? (children[0]?.name ?? null) : machine.initial
  return { ...machine, children, transitions, initial }
}

function renamed(root: EditNode, { path, name }: RenameNode): EditNode | undefined {
  const before = nameOfPath(path)
  const newName: NewName = (target) => (target === before ? name : target)
  return inMachine(root, parentPath(path), (machine) => {
    if (!nodeOf(machine, path) || freeName(machine, name) !== name) return undefined
    const children = machine.children.map((child) => {
      const made = retargeted(child, newName)
      return child.path === path ? { ...at(made, `${machine.path}/${name}`), name, label: name } : made
    })
    const transitions = machine.transitions.map((arrow) => ({
      ...arrow,
      source: newName(arrow.source),
      target: newName(arrow.target),
    }))
    return { ...machine, children, transitions, initial: machine.initial === null ? null : newName(machine.initial) }
  })
}

function begunWith(machine: EditNode, { child }: SetInitial): EditNode | undefined {
  return machine.children.some((each) => each.name === child) ? { ...machine, initial: child } : undefined
}

type Targets = EditNode['targets']

/** The graph with other own transitions of one node. */
function withTargets(root: EditNode, path: string, change: (targets: Targets) => Targets | undefined): EditNode | undefined {
  return inMachine(root, parentPath(path), (machine) => {
    const source = machine.children.find((child) => child.path === path)
    const targets = source && change(source.targets)
    if (!targets) return undefined
    // What an unknown state ends with is what it is connected by.
    if (Object.keys(targets).some((outcome) => !source.outcomes.includes(outcome))) return undefined
    const arrows = arrowsBySource(machine)
    const others = (arrows.get(source.name) ?? []).filter((arrow) => lookup(source.targets, arrow.outcome) === undefined)
    const own = Object.entries(targets).map(([outcome, target]) => ({ source: source.name, outcome, target }))
    arrows.set(source.name, [...own, ...others])
    const children = machine.children.map((child) => (child === source ? leading(child, targets) : child))
    return { ...machine, children, transitions: children.flatMap((child) => arrows.get(child.name) ?? []) }
  })
}

function leading(node: EditNode, targets: Targets): EditNode {
  return { ...node, targets, exits: node.outcomes.filter((outcome) => lookup(targets, outcome) === undefined) }
}

/** The same node where what it leads to has new names. */
function retargeted(node: EditNode, newName: NewName): EditNode {
  const measure = (given: EditNode['timeout']): EditNode['timeout'] => {
    const { to } = fieldsOf(given)
    return given && typeof to === 'string' && newName(to) !== to ? { ...given, to: newName(to) } : given
  }
  const [timeout, guard] = [measure(node.timeout), measure(node.guard)]
  const on_error = node.on_error === null ? null : newName(node.on_error)
  const isSame = Object.values(node.targets).every((target) => newName(target) === target)
  if (isSame && timeout === node.timeout && guard === node.guard && on_error === node.on_error) return node
  const targets = Object.fromEntries(Object.entries(node.targets).map(([outcome, target]) => [outcome, newName(target)]))
  return { ...node, targets, timeout, guard, on_error }
}

function arrowsBySource(holder: EditNode): Map<string, EditNode['transitions']> {
  const found = new Map<string, EditNode['transitions']>()
  for (const arrow of holder.transitions) found.set(arrow.source, [...(found.get(arrow.source) ?? []), arrow])
  return found
}

/** The container that all these are in; undefined where there is none, or where one stands twice. */
function soleParent(paths: readonly string[]): string | undefined {
  const parents = new Set(paths.map(parentPath))
  const [parent] = parents
  return parents.size === 1 && parent && new Set(paths).size === paths.length ? parent : undefined
}

function inMachine(root: EditNode, path: string, change: (machine: EditNode) => EditNode | undefined): EditNode | undefined {
  return inContainer(root, path, ['machine', 'priority'], change)
}

/** The graph with another container of one of these kinds; undefined where its outcomes would be others. */
function inContainer(
  root: EditNode,
  path: string,
  kinds: readonly string[],
  change: (holder: EditNode) => EditNode | undefined,
): EditNode | undefined {
  const before = nodeOf(root, path)
  if (!before || !kinds.includes(before.kind)) return undefined
  const after = change(before)
  if (!after) return undefined
  const [was, are] = [endsOf(before), endsOf(after)]
  if (was.length !== are.length || are.some((each) => !was.includes(each))) return undefined
  // Those of the behavior itself are in the order in which it declares them.
  const isSame = path === root.path || was.every((each, index) => each === are[index])
  return withNode(root, path, isSame ? after : leading({ ...after, outcomes: are }, after.targets))
}

/** What the arrows inside lead out to, in their order. */
function endsOf(holder: EditNode): readonly string[] {
  const inside = new Set(holder.children.map((child) => child.name))
  return [...new Set(holder.transitions.map((arrow) => arrow.target).filter((target) => !inside.has(target)))]
}
