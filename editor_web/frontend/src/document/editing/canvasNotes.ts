/** Free notes on the canvas of a container: their places, changes and names. Pure. */
import type { CanvasNote } from '../../api/types'
import { lookup, without } from '../dict'
import { freePlace, moved, type Box, type Point } from '../geometry'
import { nameOfPath } from '../path'
import { corner, type Edit } from './edits'
import { nodeOf, ROOT, withNode, type EditNode } from './model'

export type NoteColour = CanvasNote['colour']
export type { CanvasNote } from '../../api/types'

/** In the order in which they are offered. */
export const NOTE_COLOURS: readonly NoteColour[] = ['yellow', 'blue', 'green', 'pink', 'grey']
const NEW_SIZE = [200, 90] as const
const LEAST_PX = 40
const APART_PX = 12

/** Names a note: the container on whose canvas it stands, and its name there. */
export interface NoteRef {
  readonly path: string
  readonly name: string
}

export function isSameNote(one: NoteRef | undefined, other: NoteRef): boolean {
  return one?.path === other.path && one.name === other.name
}

/** The id of its box; no node or outcome has a blank in its name. */
export function noteId({ path, name }: NoteRef): string {
  return `${path}#note ${name}`
}

/** Is this the id of a note on the canvas of a container? */
export function isNoteOn(path: string, id: string): boolean {
  return id.startsWith(noteId({ path, name: '' }))
}

/** The edit that writes a note; null takes it away. */
export function setCanvasNote({ path, name }: NoteRef, note: CanvasNote | null): Edit {
  return { edit: 'set_canvas_note', path, name, note }
}

export function noteAt(root: EditNode | undefined, { path, name }: NoteRef): CanvasNote | undefined {
  return lookup(nodeOf(root, path)?.canvas_notes, name)
}

/** The graph with another note. */
export function withCanvasNote(root: EditNode, { path, name }: NoteRef, note: CanvasNote | null): EditNode {
  const holder = nodeOf(root, path)
  if (!holder) return root
  const rest = without(holder.canvas_notes, name)
  return withNode(root, path, { ...holder, canvas_notes: note ? { ...rest, [name]: note } : rest })
}

/** The boxes of the notes of a container by their ids; `origin` leads from positions of the document to boxes. */
export function noteBoxes(holder: EditNode, origin: Point = { x: 0, y: 0 }): readonly (readonly [string, Box])[] {
  return Object.entries(holder.canvas_notes).map(([name, note]) => [noteId({ path: holder.path, name }), boxOfNote(note, origin)])
}

export function boxOfNote({ position: [x, y], size: [width, height] }: CanvasNote, origin: Point): Box {
  return { ...moved({ x, y }, origin), width, height }
}

/** The place nearest to one where a new note covers nothing of what is drawn, and nothing covers it. */
export function placeForNote(at: Point, taken: readonly Box[]): Point {
  const [width, height] = NEW_SIZE
  return freePlace({ ...at, width, height }, taken, APART_PX)
}

/** A new note at a place. Its name is one that nobody else chooses who edits the same file: notes are merged by it. */
export function newNote(path: string, at: Point, random: () => number = Math.random): NoteRef & { readonly note: CanvasNote } {
  const name = `n${Math.floor(random() * 36 ** 5)
    .toString(36)
    .padStart(5, '0')}`
  return { path, name, note: { text: '', position: corner(at.x, at.y), size: NEW_SIZE, colour: 'yellow' } }
}

export function movedNote(note: CanvasNote, by: Point): CanvasNote {
  const [x, y] = note.position
  return { ...note, position: corner(x + by.x, y + by.y) }
}

export function resizedNote(note: CanvasNote, by: Point): CanvasNote {
  const [width, height] = note.size
  return { ...note, size: corner(Math.max(LEAST_PX, width + by.x), Math.max(LEAST_PX, height + by.y)) }
}

/** Said of it by a screen reader. */
export function spokenNote({ path }: NoteRef, { colour, text }: CanvasNote): string {
  const place = path === ROOT ? 'the behavior' : nameOfPath(path)
  return `${colour.charAt(0).toUpperCase()}${colour.slice(1)} note on the canvas of ${place}: ${text}`
}

/** The text in lines of at most so many letters, as it is drawn where nothing breaks lines by itself. */
export function linesOf(text: string, letters: number): readonly string[] {
  return text.split('\n').flatMap((paragraph) => {
    const lines = ['']
    for (const word of paragraph.split(' ')) {
      const last = lines.at(-1) ?? ''
      if (last !== '' && last.length + 1 + word.length > letters) lines.push(word)
      else lines[lines.length - 1] = last === '' ? word : `${last} ${word}`
      // A word longer than a line is broken anywhere.
      for (let over = lines.at(-1) ?? ''; over.length > letters; over = lines.at(-1) ?? '')
        lines.splice(-1, 1, over.slice(0, letters), over.slice(letters))
    }
    return lines
  })
}
