/** Free notes as coloured paper on the canvas, below its nodes: written, moved, resized and coloured in place. */
import { Box, Group, UnstyledButton } from '@mantine/core'
import { IconPencil, IconTrash } from '@tabler/icons-react'
import { useNodes, useReactFlow, useStore, ViewportPortal } from '@xyflow/react'
import { useEffect, useMemo, useRef, useState, type KeyboardEvent, type PointerEvent } from 'react'
import {
  boxOfNote,
  isSameNote,
  movedNote,
  NOTE_COLOURS,
  noteId,
  resizedNote,
  spokenNote,
  type CanvasNote,
  type NoteRef,
} from '../../document/editing/canvasNotes'
import { lookup, type Dict } from '../../document/dict'
import { allNodes, isForeign } from '../../document/editing/model'
import type { Point } from '../../document/geometry'
import classes from './canvas.module.css'
import { useCanvasPlaces } from './canvasPositions'
import type { CanvasNode } from './elements'
import {
  colourFreeNote,
  dropFreeNote,
  keepFreeNote,
  moveFreeNote,
  removeFreeNote,
  resizeFreeNote,
  useFreeNotes,
  writeFreeNote,
} from './freeNotes'
import { nodeBoxes } from './nodeBoxes'
import { OF_PAGE } from './pictureParts'
import { useNotes } from './notes'
import { rootOf, scopeOf, useEditor } from './store'
import { Tool } from './Tool'

/** By which the keys of the arrows move a note. */
const STEP_PX = 10
const STEPS: Dict<Point> = {
  ArrowLeft: { x: -STEP_PX, y: 0 },
  ArrowRight: { x: STEP_PX, y: 0 },
  ArrowUp: { x: 0, y: -STEP_PX },
  ArrowDown: { x: 0, y: STEP_PX },
}
const NOWHERE: Point = { x: 0, y: 0 }
/** A shorter drag is a click that shook. */
const LEAST_PX = 3

const EDGE = '1px solid color-mix(in srgb, var(--ink) 35%, transparent)'
const PAPER = {
  position: 'absolute',
  display: 'flex',
  alignItems: 'flex-start',
  overflow: 'hidden',
  padding: '8px 10px',
  border: EDGE,
  borderRadius: '3px 3px 10px',
  color: 'var(--ink)',
  fontSize: 12,
  lineHeight: 1.35,
  overflowWrap: 'anywhere',
  whiteSpace: 'pre-line',
  resize: 'none',
  pointerEvents: 'all',
} as const
const CORNER = {
  position: 'absolute',
  zIndex: 7,
  width: 14,
  height: 14,
  borderRight: '3px solid var(--ink)',
  borderBottom: '3px solid var(--ink)',
  cursor: 'nwse-resize',
  pointerEvents: 'all',
} as const

interface Placed {
  readonly at: NoteRef
  readonly note: CanvasNote
  /** Where the frame of its container is. */
  readonly origin: Point
  /** Of how many frames its container is inside; it is drawn above those and below their nodes. */
  readonly depth: number
  readonly isOfOther: boolean
}

export function FreeNoteOverlay() {
  const isShown = useNotes((s) => s.isShown)
  useMiddle()
  const placed = usePlaced()
  if (!isShown || placed.length === 0) return null
  return (
    <ViewportPortal>
      {placed.map((each) => (
        <FreeNote key={noteId(each.at)} {...each} />
      ))}
    </ViewportPortal>
  )
}

/** Say where the middle of what is seen is: a new note comes there. */
function useMiddle(): void {
  const { screenToFlowPosition } = useReactFlow()
  const pane = useStore((s) => s.domNode)
  useEffect(() => {
    const middle = () => {
      const box = pane?.getBoundingClientRect()
      return box ? screenToFlowPosition({ x: box.x + box.width / 2 - 100, y: box.y + box.height / 2 - 45 }) : NOWHERE
    }
    useFreeNotes.setState({ middle })
  }, [pane, screenToFlowPosition])
}

/** All notes of the containers whose inside is seen. */
function usePlaced(): readonly Placed[] {
  const nodes = useNodes<CanvasNode>()
  const root = useEditor(rootOf)
  const scope = useEditor(scopeOf)
  const origins = useCanvasPlaces((s) => s.origins)
  const fresh = useFreeNotes((s) => s.fresh)
  const noted = useMemo(
    () => (scope ? allNodes(scope).filter((node) => Object.keys(node.canvas_notes).length > 0 || node.path === fresh?.path) : []),
    [scope, fresh],
  )
  const frames = useMemo(() => new Map(nodes.filter((node) => node.type === 'frame').map((node) => [node.id, node])), [nodes])
  const boxes = useMemo(() => (noted.length > 0 ? nodeBoxes(nodes) : new Map<string, Point>()), [nodes, noted])
  if (!root || !scope) return []
  const depthOf = (path: string | undefined): number => (path === undefined ? 0 : 1 + depthOf(frames.get(path)?.parentId))
  return noted.flatMap((holder) => {
    const isScope = holder.path === scope.path
    const frame = isScope ? NOWHERE : frames.has(holder.path) ? boxes.get(holder.path) : undefined
    if (!frame) return []
    const inside = origins.get(holder.path) ?? NOWHERE
    const notes = Object.entries(holder.canvas_notes)
    const all = fresh?.path === holder.path ? [...notes, [fresh.name, fresh.note] as const] : notes
    return all.map(([name, note]) => ({
      at: { path: holder.path, name },
      note,
      origin: { x: frame.x + inside.x, y: frame.y + inside.y },
      depth: isScope ? 0 : depthOf(holder.path),
      isOfOther: isForeign(root, `${holder.path}/`),
    }))
  })
}

function FreeNote({ at, note, origin, depth, isOfOther }: Placed) {
  const isActive = useFreeNotes((s) => isSameNote(s.active, at))
  const isWriting = useFreeNotes((s) => isSameNote(s.writing, at))
  const [drag, setDrag] = useState<{ readonly kind: 'move' | 'resize'; readonly by: Point }>()
  const shown = !drag ? note : drag.kind === 'move' ? movedNote(note, drag.by) : resizedNote(note, drag.by)
  const box = boxOfNote(shown, origin)
  const paper = { ...PAPER, background: OF_PAGE[note.colour] }
  const size = { left: box.x, top: box.y, width: box.width, height: box.height }
  const end = (kind: 'move' | 'resize', by: Point) => {
    setDrag(undefined)
    if (kind === 'move') void moveFreeNote(at, by)
    else void resizeFreeNote(at, by)
  }
  const moving = useNoteDrag(
    (by) => setDrag(by && { kind: 'move', by }),
    (by) => end('move', by),
  )
  const sizing = useNoteDrag(
    (by) => setDrag(by && { kind: 'resize', by }),
    (by) => end('resize', by),
  )

  if (isWriting) {
    return (
      <Box
        component="textarea"
        className={`${classes['slip']} nodrag nopan nowheel`}
        style={{ ...paper, ...size, zIndex: 7 }}
        aria-label="Text of the note"
        placeholder="Information for editors of the behavior"
        defaultValue={note.text}
        ref={(field) => field?.focus({ preventScroll: true })}
        onBlur={(event) => void keepFreeNote(at, event.currentTarget.value)}
        onKeyDown={(event) => {
          if (event.key !== 'Escape' && !(event.key === 'Enter' && (event.ctrlKey || event.metaKey))) return
          event.preventDefault()
          event.stopPropagation()
          if (event.key === 'Escape') dropFreeNote()
          else event.currentTarget.blur()
          focusNote(at)
        }}
      />
    )
  }
  return (
    <div
      onFocus={() => useFreeNotes.setState({ active: at })}
      onBlur={(event) => {
        if (!event.currentTarget.contains(event.relatedTarget)) useFreeNotes.setState({ active: undefined })
      }}
    >
      <UnstyledButton
        className="nodrag nopan"
        style={{ ...paper, ...size, zIndex: depth - 1, cursor: isOfOther ? 'default' : 'grab' }}
        disabled={isOfOther}
        data-free-note={noteId(at)}
        aria-label={spokenNote(at, note)}
        title="Double-click or Enter to write, arrows to move, Shift and arrows to resize, Delete to delete"
        onDoubleClick={() => writeFreeNote(at)}
        onKeyDown={(event) => onKey(event, at)}
        {...moving}
      >
        {note.text}
      </UnstyledButton>
      {isActive && !isOfOther && (
        <>
          <Group
            role="toolbar"
            aria-label="Tools of the note"
            gap={2}
            wrap="nowrap"
            px={4}
            py={2}
            bg="var(--surface)"
            bd="1px solid var(--line)"
            bdrs="md"
            className="nodrag nopan"
            style={{ position: 'absolute', left: box.x, top: box.y - 40, zIndex: 7, pointerEvents: 'all' }}
          >
            <Tool isSmall label="Write the note" onPress={() => writeFreeNote(at)}>
              <IconPencil size={15} />
            </Tool>
            {NOTE_COLOURS.map((colour) => (
              <Tool
                key={colour}
                isSmall
                label={`Make the note ${colour}`}
                isPressed={note.colour === colour}
                onPress={() => void colourFreeNote(at, colour)}
              >
                <Box w={14} h={14} bdrs="50%" bg={OF_PAGE[colour]} bd={EDGE} />
              </Tool>
            ))}
            <Tool isSmall label="Delete the note" onPress={() => void removeFreeNote(at)}>
              <IconTrash size={15} />
            </Tool>
          </Group>
          <div
            aria-hidden
            className="nodrag nopan"
            style={{ ...CORNER, left: box.x + box.width - 12, top: box.y + box.height - 12 }}
            {...sizing}
          />
        </>
      )}
    </div>
  )
}

function onKey(event: KeyboardEvent<HTMLElement>, at: NoteRef): void {
  const step = lookup(STEPS, event.key)
  if (event.ctrlKey || event.metaKey || event.altKey) return
  if (step) void (event.shiftKey ? resizeFreeNote(at, step) : moveFreeNote(at, step))
  else if (event.key === 'Enter') writeFreeNote(at)
  else if (event.key === 'Delete' || event.key === 'Backspace') void removeFreeNote(at)
  else if (event.key === 'Escape') event.currentTarget.blur()
  else return
  event.preventDefault()
  event.stopPropagation()
}

/** Give the keyboard back to a note that was written, once it is drawn again. */
function focusNote(at: NoteRef): void {
  requestAnimationFrame(() =>
    document.querySelector<HTMLElement>(`[data-free-note="${CSS.escape(noteId(at))}"]`)?.focus({ preventScroll: true }),
  )
}

/** Following the pointer, in pixels of the document; less than a few are none. */
function useNoteDrag(follow: (by: Point | undefined) => void, done: (by: Point) => void) {
  const { getZoom } = useReactFlow()
  const start = useRef<Point>(undefined)
  const dragged = (event: PointerEvent): Point | undefined => {
    if (!start.current) return undefined
    const [x, y] = [event.clientX - start.current.x, event.clientY - start.current.y]
    return Math.hypot(x, y) < LEAST_PX ? undefined : { x: x / getZoom(), y: y / getZoom() }
  }
  return {
    onPointerDown: (event: PointerEvent<HTMLElement>) => {
      if (event.button !== 0) return
      start.current = { x: event.clientX, y: event.clientY }
      event.currentTarget.setPointerCapture(event.pointerId)
    },
    onPointerMove: (event: PointerEvent<HTMLElement>) => {
      const by = dragged(event)
      if (by) follow(by)
    },
    onPointerUp: (event: PointerEvent<HTMLElement>) => {
      const by = dragged(event)
      start.current = undefined
      if (by) done(by)
      else follow(undefined)
    },
    onPointerCancel: () => {
      start.current = undefined
      follow(undefined)
    },
  }
}
