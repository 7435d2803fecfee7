/** Where nodes are on the canvas: put, kept, in line, or laid out by itself again. */
import { layOutByElk } from '../../components/elk'
import { isNoteOn } from '../../document/editing/canvasNotes'
import { corner } from '../../document/editing/edits'
import type { Corner } from '../../document/editing/edits'
import { rowLimitOf } from '../../document/editing/expansion'
import { isMachine, isTreePart, nodeOf, type EditNode } from '../../document/editing/model'
import { aligned, type Alignment } from '../../document/editing/neighbors'
import { layOutChosen } from '../../document/editing/selectionLayout'
import type { LayoutCall } from '../../document/elkGraph'
import type { Box, Point } from '../../document/geometry'
import { nameOfPath, parentPath } from '../../document/path'
import { perform } from './apply'
import { canvasBoxes } from './canvasPositions'
import { outermost, own } from './selected'
import { rootOf, editor, isOpenNow, scopeOf, showEditorNotice, showEditorRefusal } from './store'

const LAYOUT = 'Auto-layout'

/** Forget where nodes were put: the container that fills the canvas is laid out by itself again. */
export async function layOutAnew(): Promise<void> {
  const scope = scopeOf(editor())
  const placed = scope ? positionedBelow(scope) : []
  if (placed.length === 0) {
    showEditorNotice('It is laid out already')
    return
  }
  await perform(LAYOUT, [{ edit: 'set_positions', positions: Object.fromEntries(placed.map((path) => [path, null])) }])
}

function positionedBelow(node: EditNode): readonly string[] {
  return node.children.flatMap((child) => [...(child.position ? [child.path] : []), ...positionedBelow(child)])
}

/** The children of a machine that have no positions yet, where they are seen now; none where it is laid out otherwise. */
export function seenPositions(parent: EditNode): Record<string, Corner> {
  if (!isMachine(parent.kind)) return {}
  const { boxes, origins } = canvasBoxes()
  const origin = origins.get(parent.path) ?? { x: 0, y: 0 }
  return Object.fromEntries(
    parent.children.flatMap((child): [string, Corner][] => {
      const box = child.position === null && boxes.get(child.path)
      return box ? [[child.path, corner(box.x - origin.x, box.y - origin.y)]] : []
    }),
  )
}

/**
 * Put nodes where they were dragged to; false where they are not there.
 * The first one that is moved pins its siblings, which stay where they are seen.
 */
export async function place(moved: ReadonlyMap<string, Point>, words = wordsFor(moved)): Promise<boolean> {
  const root = rootOf(editor())
  const { origins } = canvasBoxes()
  const positions: Record<string, Corner> = {}
  for (const [path, at] of moved) {
    const parent = nodeOf(root, parentPath(path))
    if (!parent || isTreePart(parent.kind) || !isMachine(parent.kind)) continue
    const origin = origins.get(parent.path) ?? { x: 0, y: 0 }
    for (const [sibling, seen] of Object.entries(seenPositions(parent))) positions[sibling] ??= seen
    positions[path] = corner(at.x - origin.x, at.y - origin.y)
  }
  if (Object.keys(positions).length === 0) return false
  return (await perform(words, [{ edit: 'set_positions', positions }])) !== undefined
}

function wordsFor(moved: ReadonlyMap<string, Point>): string {
  return moved.size === 1 ? `Move ${nameOfPath([...moved.keys()][0] ?? '')}` : `Move ${moved.size} nodes`
}

/** Lay out the selected nodes of each machine among themselves, around where they are; what is not selected stays. */
export async function layOutSelected(call: LayoutCall = layOutByElk): Promise<void> {
  const { id } = editor()
  const root = rootOf(editor())
  const paths = own(outermost(), LAYOUT)
  const scope = scopeOf(editor())
  if (!root || !scope || paths.length === 0) return
  const parents = [...new Set(paths.map(parentPath))].flatMap((path) => nodeOf(root, path) ?? [])
  const machines = parents.filter((each) => isMachine(each.kind) && paths.filter((path) => parentPath(path) === each.path).length > 1)
  if (machines.length === 0) {
    showEditorRefusal(LAYOUT, 'select two nodes or more of one machine', 'Elsewhere nodes are laid out by themselves.')
    return
  }
  const rowLimit = rowLimitOf(scope, (path) => isOpenNow(editor(), path))
  const corners = await Promise.all(machines.map((machine) => layOutChosen(machine, new Set(paths), seenIn(machine), { rowLimit, call })))
  const moved = new Map(corners.flatMap((each) => [...each]))
  if (editor().id !== id) return
  if (moved.size === 0) showEditorNotice('It is laid out already')
  else await place(moved, `${LAYOUT} of ${moved.size} nodes`)
}

/** What is drawn on the canvas of a machine: its children, and its free notes. */
function seenIn({ path, children }: EditNode): { readonly boxes: ReadonlyMap<string, Box>; readonly others: readonly Box[] } {
  const { boxes } = canvasBoxes()
  const drawn = children.flatMap((child): [string, Box][] => {
    const box = boxes.get(child.path)
    return box ? [[child.path, box]] : []
  })
  return { boxes: new Map(drawn), others: [...boxes].filter(([id]) => isNoteOn(path, id)).map(([, box]) => box) }
}

export async function align(how: Alignment): Promise<void> {
  const { boxes } = canvasBoxes()
  const chosen = new Map(outermost().flatMap((path): [string, Box][] => (boxes.has(path) ? [[path, boxes.get(path) as Box]] : [])))
  if (chosen.size < 2) {
    showEditorRefusal('Align', 'select two nodes or more')
    return
  }
  await place(aligned(chosen, how))
}
