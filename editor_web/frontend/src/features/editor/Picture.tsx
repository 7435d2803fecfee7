/** A behavior as one standing drawing, as the canvas shows it: for comparing versions and for files. */
import { getSmoothStepPath, Position } from '@xyflow/react'
import type { ReactNode } from 'react'
import { boundsOf, moved, roundedPath } from '../../document/geometry'
import type { Marking } from '../../document/editing/changes'
import { noteAt, noteId } from '../../document/editing/canvasNotes'
import { portY } from '../../document/editing/measure'
import { allNodes, isFailure } from '../../document/editing/model'
import type { Box, Point, Size } from '../../document/geometry'
import { canvasEdges, canvasNodes, type CanvasNode, type DrawnInput } from './elements'
import { nodeBoxes } from './nodeBoxes'
import { colourOf, Frame, Leaf, Paper, Pill, Rules, Twig, type Palette } from './pictureParts'

export interface PictureProps {
  readonly drawn: DrawnInput & { readonly arrangement: { readonly size: Size } }
  readonly title: string
  readonly palette: Palette
  /** By the path of a node, or the id of an arrow. */
  readonly markings?: ReadonlyMap<string, Marking>
  readonly onPick?: (path: string) => void
}

const MARGIN = 26
export function Picture({ drawn, title, palette, markings, onPick }: PictureProps) {
  const nodes = canvasNodes(drawn)
  const boxes = nodeBoxes(nodes)
  const notes = notesOf(drawn, boxes)
  const bounds = around([...boxes.values(), ...notes.map(({ box }) => box)], [...drawn.arrangement.routes.values()].flat())
  const edges = canvasEdges(drawn, [])
  return (
    <svg
      xmlns="http://www.w3.org/2000/svg"
      viewBox={`${bounds.x} ${bounds.y} ${bounds.width} ${bounds.height}`}
      width={bounds.width}
      height={bounds.height}
      role="img"
      aria-label={title}
    >
      <title>{title}</title>
      <rect {...bounds} style={{ fill: palette.canvas }} />
      {notes.map((each) => each.isOutside && <Paper key={each.id} {...each} palette={palette} />)}
      {nodes
        .filter((node) => node.type === 'frame')
        .map((node) => (
          <Frame key={node.id} node={node} box={boxOf(boxes, node.id)} palette={palette} mark={markings?.get(node.id)} onPick={onPick} />
        ))}
      {notes.map((each) => !each.isOutside && <Paper key={each.id} {...each} palette={palette} />)}
      {edges.map((edge) => {
        const source = boxes.get(edge.source)
        const target = boxes.get(edge.target)
        const from = nodes.find((node) => node.id === edge.source)
        if (!source || !target || !from) return null
        const mark = markings?.get(edge.id)
        const colour = colourOf(mark, palette.edge, palette)
        if (edge.type !== 'transition') {
          const [a, b] = [
            { x: source.x + source.width / 2, y: source.y + source.height },
            { x: target.x + target.width / 2, y: target.y },
          ]
          const bend = (a.y + b.y) / 2
          const path = a.x === b.x ? `M ${a.x} ${a.y} L ${b.x} ${b.y}` : roundedPath([a, { x: a.x, y: bend }, { x: b.x, y: bend }, b])
          return <path key={edge.id} d={path} style={{ fill: 'none', stroke: colour, strokeWidth: 1.6 }} />
        }
        const points = waypoints(
          edge.data?.points,
          from,
          source,
          target,
          nodes.find((node) => node.id === edge.target),
          edge.data?.outcome ?? '',
        )
        return (
          <g key={edge.id}>
            <path
              d={points.path}
              style={{
                fill: 'none',
                stroke: colour,
                strokeWidth: mark ? 2.6 : 1.6,
                strokeDasharray: isFailure(edge.data?.outcome ?? '') ? '5 4' : undefined,
              }}
            />
            <path d={head(points.end)} style={{ fill: colour }} />
          </g>
        )
      })}
      {nodes.map((node): ReactNode => {
        const box = boxOf(boxes, node.id)
        switch (node.type) {
          case 'leaf':
          case 'twig': {
            const Part = node.type === 'leaf' ? Leaf : Twig
            const mark = markings?.get(node.id)
            return <Part key={node.id} node={node} box={box} palette={palette} mark={mark} onPick={onPick} />
          }
          case 'pill':
            return <Pill key={node.id} node={node} box={box} palette={palette} />
          case 'rules':
            return (
              <g key={node.id}>
                <rect {...box} rx={10} style={{ fill: palette.pill, stroke: palette.line }} />
                <Rules node={node.data.node} box={box} palette={palette} />
              </g>
            )
          default:
            return null
        }
      })}
    </svg>
  )
}

/** The free notes of all containers whose inside is drawn; those outside of every frame lie below the frames. */
function notesOf({ scope, arrangement }: DrawnInput, boxes: ReadonlyMap<string, Box>) {
  return allNodes(scope).flatMap((holder) =>
    Object.keys(holder.canvas_notes).flatMap((name) => {
      const ref = { path: holder.path, name }
      const [note, own] = [noteAt(holder, ref), arrangement.boxes.get(noteId(ref))]
      const isOutside = holder === scope
      const frame = isOutside ? { x: 0, y: 0 } : boxes.get(holder.path)
      return note && own && frame ? [{ id: noteId(ref), note, isOutside, box: { ...own, ...moved(own, frame) } }] : []
    }),
  )
}

/** Along the laid-out points, else as the canvas draws it from port to port. */
function waypoints(
  points: readonly Point[] | undefined,
  from: CanvasNode,
  source: Box,
  target: Box,
  to: CanvasNode | undefined,
  outcome: string,
): { readonly path: string; readonly end: Point } {
  const last = points?.at(-1)
  if (points && last) return { path: roundedPath(points, 7), end: last }
  const transitions = from.type === 'leaf' || from.type === 'frame' ? from.data.transitions : []
  const index = Math.max(
    0,
    transitions.findIndex((transition) => transition.outcome === outcome),
  )
  const entry = to && 'entryY' in to.data ? to.data['entryY'] : target.height / 2
  const end = { x: target.x, y: target.y + entry }
  const [path] = getSmoothStepPath({
    sourceX: source.x + source.width,
    sourceY: source.y + portY(source.height, transitions.length, index),
    targetX: end.x,
    targetY: end.y,
    sourcePosition: Position.Right,
    targetPosition: Position.Left,
    borderRadius: 8,
    offset: 18,
  })
  return { path, end }
}

function head({ x, y }: Point): string {
  return `M ${x - 8} ${y - 4} L ${x + 1} ${y} L ${x - 8} ${y + 4} z`
}

function boxOf(boxes: ReadonlyMap<string, Box>, id: string): Box {
  return boxes.get(id) ?? { x: 0, y: 0, width: 0, height: 0 }
}

function around(boxes: readonly Box[], points: readonly Point[]): Box {
  const all = [...boxes, ...points.map((point) => ({ ...point, width: 0, height: 0 }))]
  if (all.length === 0) return { x: 0, y: 0, width: 240, height: 80 }
  const { x, y, width, height } = boundsOf(all)
  return { x: x - MARGIN, y: y - MARGIN, width: width + 2 * MARGIN, height: height + 2 * MARGIN }
}
