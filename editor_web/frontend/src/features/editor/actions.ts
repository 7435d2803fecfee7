/** What can be done with the document, in terms of what is chosen: each becomes edits that the server applies. */
import type { Dict } from '../../document/dict'
import { documents } from '../../api/documents'
import { wordsOf } from '../../api/client'
import { edgeOf, sourceOf, type EdgeId } from '../../document/edgeId'
import { corner, setField, type AddNode, type Corner, type Edit, type GroupKind } from '../../document/editing/edits'
import { allNodes, freeName, holderOf, isComposite, isMachine, isTreePart, nodeOf, ROOT, type EditNode } from '../../document/editing/model'
import type { Point } from '../../document/geometry'
import { nameOfPath, parentPath } from '../../document/path'
import { inTurn, perform, performOn } from './apply'
import { canvasBoxes } from './canvasPositions'
import { fromClipboard, toClipboard } from './clipboard'
import { place, seenPositions } from './placing'
import { outermost, own } from './selected'
import { chosenOf, draftOf, editor, showEditorRefusal, rootOf, scopeOf, setEditor, showEditorNotice, type AddRequest } from './store'

/** What a new node is. */
export interface Addition {
  readonly kind: string
  readonly runs?: string
  readonly parameters?: Dict<unknown>
  /** What it is called, as far as the name is free. */
  readonly name: string
}

export function choose(paths: readonly string[]): void {
  setEditor({ selection: paths, arrow: undefined, ...(paths.length > 0 ? { tab: 'node' as const } : {}) })
}

export function chooseArrow(arrow: EdgeId | undefined): void {
  setEditor({ arrow, selection: arrow ? [] : editor().selection })
}

/** Add a node; where the request comes from a port or an arrow, it is connected too. */
export async function add(what: Addition, request: AddRequest): Promise<void> {
  const root = rootOf(editor())
  const parent = nodeOf(root, request.parent)
  if (!root || !parent) return
  const name = freeName(parent, what.name)
  const isPlaced = request.at !== undefined && isMachine(parent.kind)
  const seen = isPlaced ? seenPositions(parent) : {}
  const kept: Edit[] = Object.keys(seen).length > 0 ? [{ edit: 'set_positions', positions: seen }] : []
  const after = request.from ? undefined : afterOf(parent)
  const node: AddNode = {
    edit: 'add_node',
    parent: parent.path,
    kind: what.kind,
    name,
    ...(what.runs ? { runs: what.runs } : {}),
    ...(what.parameters ? { parameters: what.parameters } : {}),
    ...(isPlaced && request.at ? { position: corner(request.at.x, request.at.y) } : {}),
    ...(after ? { after } : {}),
    ...(request.from?.isInsert ? { on_edge: { from: request.from.path, outcome: request.from.outcome } } : {}),
  }
  const transition: Edit[] =
    request.from && !request.from.isInsert
      ? [{ edit: 'set_transition', path: request.from.path, outcome: request.from.outcome, target: name }]
      : []
  const answer = await perform(`Add ${name}`, [...kept, node, ...transition])
  const made = answer?.changed.find((path) => parentPath(path) === parent.path && nameOfPath(path) === name) ?? `${parent.path}/${name}`
  if (answer && nodeOf(rootOf(editor()), made)) {
    if (parent.path !== editor().scope && !made.startsWith(`${editor().scope}/`)) setEditor({ scope: parent.path })
    if (parent.path !== editor().scope) setEditor({ opened: new Map(editor().opened).set(parent.path, true) })
    choose([made])
    focusNode(made)
  }
}

/** The chosen sibling, after which something new comes. */
function afterOf(parent: EditNode): string | undefined {
  const chosen = chosenOf(editor())
  return chosen && isMachine(parent.kind) && parentPath(chosen.path) === parent.path ? chosen.path : undefined
}

/** Put the keyboard on a node once it is drawn. */
export function focusNode(path: string): void {
  setEditor({ shown: { path } })
}

export async function remove(): Promise<void> {
  const { arrow } = editor()
  if (arrow) {
    const edge = edgeOf(arrow)
    setEditor({ arrow: undefined })
    if (edge) await perform(`Disconnect ${edge.outcome}`, [disconnection(sourceOf(edge), edge.outcome)])
    return
  }
  const paths = own(outermost(), 'Delete')
  if (paths.length === 0) return
  const next = parentPath(paths[0] ?? '')
  const label = paths.length === 1 ? `Delete ${nameOfPath(paths[0] ?? '')}` : `Delete ${paths.length} nodes`
  const done = perform(label, [{ edit: 'remove_nodes', paths }])
  const goOn = () => {
    if (next && next !== editor().scope && nodeOf(rootOf(editor()), next)) choose([next])
  }
  const isShown = !nodeOf(rootOf(editor()), paths[0] ?? '')
  if (isShown) goOn()
  const takeBack = whereUntouched()
  const answer = await done
  if (!answer) takeBack(paths)
  else if (!isShown) goOn()
}

/** Chooses again what an edit that the server refuses was made of, unless something else was chosen or opened meanwhile. */
function whereUntouched(): (paths: readonly string[]) => void {
  const { id, selection } = editor()
  return (paths) => {
    const now = editor()
    if (now.id !== id || !now.selection.every((path) => selection.includes(path))) return
    choose(paths.filter((path) => nodeOf(rootOf(now), path)))
  }
}

function disconnection(path: string, outcome: string): Edit {
  const node = nodeOf(rootOf(editor()), path)
  if (node && !node.outcomes.includes(outcome)) {
    if (outcome === 'error') return setField(path, 'on_error', null)
    return setField(path, outcome.startsWith('after ') ? 'timeout' : 'guard', null)
  }
  return { edit: 'clear_transition', path, outcome }
}

export async function rename(path: string, name: string): Promise<void> {
  // Enter and the loss of the keyboard that follows it are one.
  if (editor().renaming !== path) return
  setEditor({ renaming: undefined })
  if (name === nameOfPath(path)) return
  const made = `${parentPath(path)}/${name}`
  const done = perform(`Rename ${nameOfPath(path)} to ${name}`, [{ edit: 'rename_node', path, name }])
  const isShown = nodeOf(rootOf(editor()), made) !== undefined
  if (isShown) choose([made])
  const takeBack = whereUntouched()
  const answer = await done
  if (answer && nodeOf(rootOf(editor()), made)) {
    if (!isShown) choose([made])
    focusNode(made)
  } else if (!answer && isShown) takeBack([path])
}

export async function duplicate(): Promise<void> {
  const paths = own(outermost(), 'Duplicate')
  if (paths.length === 0) return
  const before = rootOf(editor())
  const done = perform('Duplicate', [{ edit: 'duplicate', paths }])
  // What is pressed next is meant for the copies that are seen.
  const shown = before ? siblingsOf(paths).filter((path) => !nodeOf(before, path)) : []
  if (shown.length > 0) choose(shown)
  const takeBack = whereUntouched()
  const answer = await done
  if (!answer) takeBack(paths)
  else if (shown.length === 0) chooseChanged(answer.changed, paths)
}

function siblingsOf(paths: readonly string[]): readonly string[] {
  const parents = new Set(paths.map(parentPath))
  return [...parents].flatMap((parent) => nodeOf(rootOf(editor()), parent)?.children.map((child) => child.path) ?? [])
}

function chooseChanged(changed: readonly string[], before: readonly string[]): void {
  const made = changed.filter((path) => !before.includes(path) && nodeOf(rootOf(editor()), path))
  const tops = made.filter((path) => !made.some((other) => path.startsWith(`${other}/`)))
  if (tops.length > 0) choose(tops)
}

export async function copy(cut = false): Promise<void> {
  const paths = own(outermost(), cut ? 'Cut' : 'Copy')
  if (paths.length === 0) return
  const { id } = editor()
  try {
    // After what is shown already: a copy that is not written yet is in no text.
    const { yaml } = await inTurn(() => documents.copy(id, draftOf(editor()).text, paths))
    await toClipboard(yaml)
    showEditorNotice(paths.length === 1 ? `Copied ${nameOfPath(paths[0] ?? '')}` : `Copied ${paths.length} nodes`)
    if (cut) await remove()
  } catch (error) {
    showEditorRefusal(cut ? 'Cut' : 'Copy', wordsOf(error))
  }
}

export async function paste(): Promise<void> {
  const root = rootOf(editor())
  await pasteText(await fromClipboard(), root)
}

async function pasteText(yaml: string, root = rootOf(editor())): Promise<void> {
  if (!root || !yaml.trim()) {
    showEditorRefusal('Paste', 'the clipboard is empty', 'Copy nodes first, here or in another behavior.')
    return
  }
  const chosen = chosenOf(editor())
  const beside = chosen ? parentPath(chosen.path) : editor().scope
  const parent = holderOf(root, beside || ROOT)
  if (!parent) return
  const answer = await perform('Paste', [{ edit: 'paste', parent: parent.path, yaml }])
  if (answer) chooseChanged(answer.changed, [])
}

/** Select the nodes of this behavior that run the same state, behavior or behaviour as the selected one. */
export function selectAlike(): void {
  const root = rootOf(editor())
  const chosen = chosenOf(editor())
  if (!root || !chosen?.title) return
  choose(
    allNodes(root)
      .filter((node) => node.kind === chosen.kind && node.title === chosen.title)
      .map((node) => node.path),
  )
}

export function selectAll(): void {
  choose(scopeOf(editor())?.children.map((child) => child.path) ?? [])
}

export async function group(kind: GroupKind): Promise<void> {
  const paths = own(outermost(), 'Group')
  if (paths.length === 0) return
  const parent = nodeOf(rootOf(editor()), parentPath(paths[0] ?? ''))
  const name = freeName(parent, 'group')
  const answer = await perform('Group', [{ edit: 'group', paths, kind, name }])
  const made = `${parent?.path ?? ''}/${name}`
  if (answer) choose(nodeOf(rootOf(editor()), made) ? [made] : [])
}

export async function ungroup(): Promise<void> {
  const chosen = chosenOf(editor())
  if (!chosen || chosen.path === ROOT) return
  const answer = await perform(`Ungroup ${chosen.name}`, [{ edit: 'ungroup', path: chosen.path }])
  if (answer) chooseChanged(answer.changed, [])
}

export async function connect(path: string, outcome: string, target: string): Promise<void> {
  await perform(`Connect ${outcome} to ${target}`, [{ edit: 'set_transition', path, outcome, target }])
}

export async function disconnect(path: string, outcome: string): Promise<void> {
  await perform(`Disconnect ${outcome}`, [disconnection(path, outcome)])
}

export async function autoConnect(): Promise<void> {
  const { selection, scope } = editor()
  await perform('Add obvious transitions', [{ edit: 'auto_connect', paths: selection.length > 0 ? selection : [scope] }])
}

export async function makeInitial(): Promise<void> {
  const chosen = chosenOf(editor())
  const parent = chosen && nodeOf(rootOf(editor()), parentPath(chosen.path))
  if (!chosen || !parent || !isMachine(parent.kind)) return
  await perform(`Start with ${chosen.name}`, [{ edit: 'set_initial', path: parent.path, child: chosen.name }])
}

/** Move the chosen nodes by a step of the keyboard: elsewhere on the canvas, or among the children where their order counts. */
export async function nudge(x: number, y: number): Promise<void> {
  const root = rootOf(editor())
  const chosen = chosenOf(editor())
  const parent = chosen && nodeOf(root, parentPath(chosen.path))
  if (!chosen || !parent) return
  if (isComposite(parent.kind) || parent.kind === 'concurrency') {
    await reorder(parent, chosen.name, x < 0 || y < 0 ? -1 : 1)
    return
  }
  const { boxes } = canvasBoxes()
  await place(
    new Map(
      outermost().flatMap((path) => {
        const box = boxes.get(path)
        return box ? [[path, { x: box.x + x, y: box.y + y }] as const] : []
      }),
    ),
  )
}

export async function reorder(parent: EditNode, name: string, by: number): Promise<void> {
  const answer = await performOn(parent.path, `Move ${name}`, (now) => {
    const order = now.children.map((child) => child.name)
    const from = order.indexOf(name)
    const to = Math.max(0, Math.min(order.length - 1, from + by))
    if (from < 0 || from === to) return []
    order.splice(to, 0, ...order.splice(from, 1))
    return [setField(parent.path, 'order', order)]
  })
  if (answer) chooseChanged([`${parent.path}/${name}`], [])
}

/** Move nodes into another container; where it is a machine, they stay where they were dropped in it. */
export async function moveInto(paths: readonly string[], parent: string, at = new Map<string, Point>()): Promise<void> {
  const holder = nodeOf(rootOf(editor()), parent)
  const names = new Set(holder?.children.map((child) => child.name))
  const isPlaced = holder && isMachine(holder.kind) && paths.every((path) => at.has(path) && !names.has(nameOfPath(path)))
  const dropped = paths.flatMap((path): [string, Corner][] => {
    const point = at.get(path)
    return point ? [[`${parent}/${nameOfPath(path)}`, corner(point.x, point.y)]] : []
  })
  const answer = await perform(`Move into ${nameOfPath(parent)}`, [
    { edit: 'move_nodes', paths, parent },
    ...(isPlaced ? [{ edit: 'set_positions' as const, positions: { ...seenPositions(holder), ...Object.fromEntries(dropped) } }] : []),
  ])
  if (answer) choose(paths.map((path) => `${parent}/${nameOfPath(path)}`).filter((path) => nodeOf(rootOf(editor()), path)))
}

/** Go into a container, so that its inside fills the canvas. */
export function enter(path: string): void {
  const node = nodeOf(rootOf(editor()), path)
  if (!node) return
  const scope = isTreePart(node.kind) && node.kind !== 'tree' ? parentPath(path) : path
  const first = node.children[0]?.path
  setEditor({ scope, selection: first ? [first] : [], arrow: undefined })
  if (first) focusNode(first)
}

/** Go out of the container that fills the canvas, and choose it. */
export function leave(): void {
  const { scope } = editor()
  if (scope === ROOT) {
    choose([])
    return
  }
  setEditor({ scope: parentPath(scope) || ROOT, selection: [scope], arrow: undefined })
  focusNode(scope)
}

export function toggleOpen(path: string, isOpen: boolean): void {
  setEditor({ opened: new Map(editor().opened).set(path, !isOpen) })
}

/** Open all that is inside of what fills the canvas, the whole behavior at once; where all is open, close it. */
export function openOrCloseAll(): void {
  const state = editor()
  const scope = scopeOf(state)
  const inside = scope ? allNodes(scope).filter((node) => node.path !== scope.path && node.children.length > 0) : []
  const isAllOpen = inside.every((node) => state.opened.get(node.path))
  setEditor({ opened: isAllOpen ? new Map() : new Map(inside.map((node) => [node.path, true])) })
}
