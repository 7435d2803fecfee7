/** Free notes of the canvas: which one has the keyboard, which one is being written, and changing them. */
import { isForeign } from '../../document/editing/model'
import {
  isSameNote,
  movedNote,
  newNote,
  noteAt,
  placeForNote,
  resizedNote,
  setCanvasNote,
  type CanvasNote,
  type NoteColour,
  type NoteRef,
} from '../../document/editing/canvasNotes'
import type { Point } from '../../document/geometry'
import { pageStore } from '../../api/pageStore'
import { perform } from './apply'
import { canvasBoxes } from './canvasPositions'
import { useNotes } from './notes'
import { editor, rootOf, scopeOf, showEditorRefusal } from './store'

interface FreeNotes {
  /** Its tools are shown. */
  readonly active: NoteRef | undefined
  readonly writing: NoteRef | undefined
  /** One that is written for the first time, and in the document once it says something. */
  readonly fresh: (NoteRef & { readonly note: CanvasNote }) | undefined
  /** Where the middle of the canvas is that is seen. */
  readonly middle: () => Point
}

export const useFreeNotes = pageStore<FreeNotes>(() => ({
  active: undefined,
  writing: undefined,
  fresh: undefined,
  middle: () => ({ x: 0, y: 0 }),
}))

/** Write a new note in the middle of what is seen of the canvas. */
export function addFreeNote(): void {
  const [root, scope] = [rootOf(editor()), scopeOf(editor())]
  if (!root || !scope) return
  if (isForeign(root, `${scope.path}/`)) {
    showEditorRefusal('Note', 'this is part of another behavior', 'Open that behavior and write it there.')
    return
  }
  const { boxes, outer, origins } = canvasBoxes()
  const place = placeForNote(
    useFreeNotes.getState().middle(),
    [...boxes].filter(([id]) => outer.has(id)).map(([, box]) => box),
  )
  const origin = origins.get(scope.path) ?? { x: 0, y: 0 }
  const { path, name, note } = newNote(scope.path, { x: place.x - origin.x, y: place.y - origin.y })
  useNotes.setState({ isShown: true })
  useFreeNotes.setState({ fresh: { path, name, note }, writing: { path, name }, active: { path, name } })
}

export function writeFreeNote({ path, name }: NoteRef): void {
  useFreeNotes.setState({ writing: { path, name } })
}

/** Take what was written; a note that says nothing is none. */
export async function keepFreeNote(ref: NoteRef, text: string): Promise<void> {
  const { writing, fresh } = useFreeNotes.getState()
  // Escape and the loss of the keyboard that follows it are one.
  if (!isSameNote(writing, ref)) return
  useFreeNotes.setState({ writing: undefined, fresh: undefined })
  const words = text.trim()
  if (isSameNote(fresh, ref)) {
    if (fresh && words) await perform('Add a note', [setCanvasNote(ref, { ...fresh.note, text: words })])
    return
  }
  if (words) await change(ref, 'Write a note', (note) => ({ ...note, text: words }))
  else await removeFreeNote(ref)
}

export function dropFreeNote(): void {
  useFreeNotes.setState({ writing: undefined, fresh: undefined })
}

export async function removeFreeNote(ref: NoteRef): Promise<void> {
  if (!noteAt(rootOf(editor()), ref)) return
  useFreeNotes.setState({ active: undefined })
  await perform('Delete a note', [setCanvasNote(ref, null)])
}

export function moveFreeNote(ref: NoteRef, by: Point): Promise<void> {
  return change(ref, 'Move a note', (note) => movedNote(note, by))
}

export function resizeFreeNote(ref: NoteRef, by: Point): Promise<void> {
  return change(ref, 'Resize a note', (note) => resizedNote(note, by))
}

export function colourFreeNote(ref: NoteRef, colour: NoteColour): Promise<void> {
  return change(ref, `Colour a note ${colour}`, (note) => ({ ...note, colour }))
}

async function change(ref: NoteRef, label: string, to: (note: CanvasNote) => CanvasNote): Promise<void> {
  const note = noteAt(rootOf(editor()), ref)
  if (!note) return
  const next = to(note)
  if (JSON.stringify(next) !== JSON.stringify(note)) await perform(label, [setCanvasNote(ref, next)])
}
