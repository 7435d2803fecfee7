/** The parts of a standing drawing: nodes, containers, branches of trees, outcomes, rules, and what is marked on them. */
import { FRAME_HEAD, pillWidth, portY, RULE_HEIGHT, rowsHeight, tableHeight } from '../../document/editing/measure'
import type { Marking } from '../../document/editing/changes'
import { isFailure, type EditNode } from '../../document/editing/model'
import { consequenceOf } from '../../document/editing/rules'
import { linesOf, type CanvasNote } from '../../document/editing/canvasNotes'
import type { Box } from '../../document/geometry'
import { kindLabel } from '../../document/tree'
import type { CanvasNode, CardNode, PillNode } from './elements'

/** Of which colour each part is: variables of the page, or what they stand for. */
export interface Palette {
  readonly canvas: string
  readonly card: string
  readonly pill: string
  readonly frame: string
  readonly line: string
  readonly edge: string
  readonly text: string
  readonly quiet: string
  readonly failed: string
  readonly done: string
  readonly changed: string
  readonly ink: string
  /** The paper of free notes by their colour. */
  readonly yellow: string
  readonly blue: string
  readonly green: string
  readonly pink: string
  readonly grey: string
}

/** The colours of the page, also when its theme is changed. */
export const OF_PAGE: Palette = {
  canvas: 'var(--canvas)',
  card: 'var(--raised)',
  pill: 'var(--surface)',
  frame: 'var(--container)',
  line: 'var(--line-strong)',
  edge: 'var(--edge)',
  text: 'var(--text)',
  quiet: 'var(--quiet)',
  failed: 'var(--failed)',
  done: 'var(--done)',
  changed: 'var(--stopped)',
  ink: 'var(--ink)',
  yellow: 'var(--paper)',
  blue: 'var(--accent-soft)',
  green: 'var(--done-soft)',
  pink: 'var(--note-pink)',
  grey: 'var(--note-grey)',
}

/** What the variables of the page stand for: a file of its own has none. */
export function paletteOf(token: (name: string) => string): Palette {
  const value = (variable: string) => token(variable.slice('var(--'.length, -1))
  const entries = Object.entries(OF_PAGE).map(([part, variable]) => [part, inOldWords(value(String(variable)))])
  return Object.fromEntries(entries) as Palette
}

/** `rgb(30 50 90 / 2.6%)` as programs know it that draw pictures and are no browsers. */
function inOldWords(colour: string): string {
  const [, r, g, b, percent] = /^rgb\((\d+) (\d+) (\d+) \/ ([\d.]+)%\)$/.exec(colour) ?? []
  return percent === undefined ? colour : `rgba(${r}, ${g}, ${b}, ${Number(percent) / 100})`
}

const SANS =
  "'Inter Variable', Inter, system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', 'Noto Sans', 'DejaVu Sans', sans-serif"
const MONO = "ui-monospace, Menlo, Consolas, 'DejaVu Sans Mono', monospace"

export interface PartProps {
  readonly node: CanvasNode
  readonly box: Box
  readonly palette: Palette
  readonly mark: Marking | undefined
  readonly onPick: ((path: string) => void) | undefined
}

export function colourOf(mark: Marking | undefined, otherwise: string, palette: Palette): string {
  if (mark === 'added') return palette.done
  if (mark === 'removed') return palette.failed
  return mark === 'changed' ? palette.changed : otherwise
}

const SIGNS: Readonly<Record<Marking, string>> = { added: '+', removed: '−', changed: '≠' }

/** A coloured sign at the corner: colour alone does not tell everybody. */
function Sign({ mark, box, palette }: { mark: Marking | undefined; box: Box; palette: Palette }) {
  if (!mark) return null
  const at = { x: box.x + box.width - 4, y: box.y + 2 }
  return (
    <g>
      <circle cx={at.x} cy={at.y} r={9} style={{ fill: colourOf(mark, palette.line, palette) }} />
      <text x={at.x} y={at.y + 4.5} style={{ fontFamily: SANS, fontSize: 14, fontWeight: 700, textAnchor: 'middle', fill: palette.card }}>
        {SIGNS[mark]}
      </text>
      <title>{mark}</title>
    </g>
  )
}

function pickable(path: string, onPick: PartProps['onPick']) {
  return onPick ? { onClick: () => onPick(path), style: { cursor: 'pointer' } } : {}
}

type BodyProps = Pick<PartProps, 'box' | 'palette' | 'mark'> & { readonly of: EditNode; readonly fill: string }

function Body({ of, fill, box, palette, mark }: BodyProps) {
  const stroke = colourOf(mark, palette.line, palette)
  const strokeDasharray = of.kind === 'concurrency' ? '5 4' : undefined
  return <rect {...box} rx={10} style={{ fill, stroke, strokeWidth: mark ? 2.6 : 1.5, strokeDasharray }} />
}

export function Frame({ node, box, palette, mark, onPick }: PartProps) {
  const { node: of, transitions } = (node as CardNode).data
  return (
    <g {...pickable(node.id, onPick)}>
      <Body of={of} fill={palette.frame} box={box} palette={palette} mark={mark} />
      <text x={box.x + 14} y={box.y + FRAME_HEAD / 2 + 5} style={{ fontFamily: SANS, fontSize: 14, fontWeight: 620, fill: palette.text }}>
        {of.name}
        <tspan dx={8} style={{ fontSize: 11.5, fontWeight: 400, fill: palette.quiet }}>
          {of.title || kindLabel(of.kind)}
        </tspan>
      </text>
      {tableHeight(of) > 0 && (
        <Rules node={of} palette={palette} box={{ ...box, y: box.y + box.height - rowsHeight(transitions.length) - tableHeight(of) }} />
      )}
      <Transitions node={node as CardNode} box={box} palette={palette} />
      <Initial node={node as CardNode} box={box} palette={palette} />
      <Sign mark={mark} box={box} palette={palette} />
    </g>
  )
}

export function Leaf({ node, box, palette, mark, onPick }: PartProps) {
  const { node: of, transitions, count } = (node as CardNode).data
  const below = of.title || (count === 0 ? `${kindLabel(of.kind)}, empty` : `${kindLabel(of.kind)} of ${count}`)
  return (
    <g {...pickable(node.id, onPick)}>
      <Body of={of} fill={palette.card} box={box} palette={palette} mark={mark} />
      <text x={box.x + 13} y={box.y + 21} style={{ fontFamily: SANS, fontSize: 14, fontWeight: 620, fill: palette.text }}>
        {fitted(of.name, (box.width - 26) / 8.2)}
      </text>
      <text x={box.x + 13} y={box.y + 37} style={{ fontFamily: MONO, fontSize: 11, fill: palette.quiet }}>
        {fitted(below, (box.width - 22) / 6.7)}
      </text>
      {transitions.length > 0 && (
        <line
          x1={box.x}
          x2={box.x + box.width}
          y1={box.y + box.height - rowsHeight(transitions.length)}
          y2={box.y + box.height - rowsHeight(transitions.length)}
          style={{ stroke: palette.line, strokeWidth: 0.7 }}
        />
      )}
      <Transitions node={node as CardNode} box={box} palette={palette} />
      <Initial node={node as CardNode} box={box} palette={palette} />
      <Sign mark={mark} box={box} palette={palette} />
    </g>
  )
}

function Transitions({ node, box, palette }: { node: CardNode; box: Box; palette: Palette }) {
  const { transitions, drawn } = node.data
  return transitions.map((transition, index) => {
    const y = box.y + portY(box.height, transitions.length, index)
    const words =
      transition.target === undefined || drawn.has(transition.outcome) || transition.target === transition.outcome
        ? transition.outcome
        : `${transition.outcome} → ${transition.target}`
    return (
      <g key={transition.outcome}>
        <text
          x={box.x + box.width - 13}
          y={y + 4}
          style={{
            fontFamily: SANS,
            fontSize: 12,
            textAnchor: 'end',
            fill: transition.target === undefined ? palette.failed : palette.text,
          }}
        >
          {fitted(words, (box.width - 26) / 6.2)}
        </text>
        <circle cx={box.x + box.width} cy={y} r={4.5} style={{ fill: transition.target === undefined ? palette.failed : palette.edge }} />
      </g>
    )
  })
}

function Initial({ node, box, palette }: { node: CardNode; box: Box; palette: Palette }) {
  if (!node.data.isInitial) return null
  const at = { x: box.x + 3, y: box.y + 3 }
  return (
    <g>
      <title>begins here</title>
      <circle cx={at.x} cy={at.y} r={8} style={{ fill: palette.text }} />
      <path d={`M ${at.x - 2.5} ${at.y - 4} L ${at.x + 4.5} ${at.y} L ${at.x - 2.5} ${at.y + 4} z`} style={{ fill: palette.canvas }} />
    </g>
  )
}

export function Twig({ node, box, palette, mark, onPick }: PartProps) {
  const of = (node as CardNode).data.node
  return (
    <g {...pickable(node.id, onPick)}>
      <rect
        {...box}
        rx={box.height / 2}
        style={{ fill: palette.pill, stroke: colourOf(mark, palette.line, palette), strokeWidth: mark ? 2.6 : 1.5 }}
      />
      <text
        x={box.x + box.width / 2}
        y={box.y + box.height / 2 + 5}
        style={{ fontFamily: SANS, fontSize: 13.5, fontWeight: 620, textAnchor: 'middle', fill: palette.text }}
      >
        {of.name === of.kind
          ? of.name
          : `${of.name} · ${of.kind}`.length * 7.4 < box.width - 16
            ? `${of.name} · ${of.kind}`
            : fitted(of.name, (box.width - 16) / 7.6)}
      </text>
      <Sign mark={mark} box={box} palette={palette} />
    </g>
  )
}

export function Rules({ node, box, palette }: { node: EditNode; box: Box; palette: Palette }) {
  const lines = [
    ...node.rules.map((rule) => [
      consequenceOf(rule),
      (rule.at_least === null ? '' : `${rule.at_least} of `) +
        Object.entries(rule.when)
          .map(([child, outcome]) => `${child} = ${outcome}`)
          .join(rule.at_least === null ? ' and ' : ', '),
    ]),
    ...(node.otherwise ? [[node.otherwise, 'otherwise']] : []),
  ]
  return (
    <g style={{ fontFamily: SANS }}>
      <line x1={box.x} x2={box.x + box.width} y1={box.y} y2={box.y} style={{ stroke: palette.line, strokeWidth: 0.7 }} />
      <text x={box.x + 12} y={box.y + 18} style={{ fontSize: 11, fill: palette.quiet }}>
        Ends with
      </text>
      {lines.map(([outcome, when], index) => (
        <text key={index} x={box.x + 12} y={box.y + 18 + (index + 1) * RULE_HEIGHT} style={{ fontSize: 12, fill: palette.text }}>
          <tspan style={{ fontWeight: 620 }}>{outcome}</tspan>
          <tspan x={box.x + 12 + Math.max(80, (outcome ?? '').length * 7.5 + 14)} style={{ fill: palette.quiet }}>
            {fitted(when ?? '', (box.width - 110) / 6.2)}
          </tspan>
        </text>
      ))}
    </g>
  )
}

const NOTE_LINE = 16.2

/** A free note, as much of its text as there is room for. */
export function Paper({ note, box, palette }: { note: CanvasNote; box: Box; palette: Palette }) {
  const lines = linesOf(note.text, Math.max(1, Math.floor((box.width - 20) / 6.2)))
  const room = Math.max(1, Math.floor((box.height - 14) / NOTE_LINE))
  return (
    <g data-note>
      <rect {...box} rx={4} style={{ fill: palette[note.colour], stroke: palette.ink, strokeOpacity: 0.35 }} />
      {lines.slice(0, room).map((line, index) => (
        <text key={index} x={box.x + 11} y={box.y + 20 + index * NOTE_LINE} style={{ fontFamily: SANS, fontSize: 12, fill: palette.ink }}>
          {index === room - 1 && lines.length > room ? `${line} …` : line}
        </text>
      ))}
    </g>
  )
}

function fitted(words: string, characters: number): string {
  return words.length <= characters ? words : `${words.slice(0, Math.max(1, Math.floor(characters) - 1))}…`
}

export function Pill({ node, box, palette }: { node: PillNode; box: Box; palette: Palette }) {
  const { outcome, count } = node.data
  const words = count === 1 || pillWidth(outcome) + 20 > box.width ? outcome : `${outcome} ×${count}`
  return (
    <g>
      <rect
        {...box}
        rx={box.height / 2}
        style={{
          fill: palette.pill,
          stroke: palette.line,
          strokeWidth: 1.5,
          strokeDasharray: isFailure(outcome) ? '5 4' : undefined,
        }}
      />
      <text
        x={box.x + box.width / 2}
        y={box.y + box.height / 2 + 4}
        style={{ fontFamily: SANS, fontSize: 12, fontWeight: 560, textAnchor: 'middle', fill: palette.text }}
      >
        {words}
      </text>
    </g>
  )
}
