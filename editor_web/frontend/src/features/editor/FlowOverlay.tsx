/** Arrows over the canvas from those that write a key to those that read it. */
import { useNodes, ViewportPortal } from '@xyflow/react'
import { useMemo } from 'react'
import { drawnLinks, flowCurve, linksOf, type FlowLink } from '../../document/editing/dataFlow'
import type { Box } from '../../document/geometry'
import { useDataFlow } from './dataFlow'
import type { CanvasNode } from './elements'
import { nodeBoxes } from './nodeBoxes'
import { ArrowHeads } from './ArrowHeads'
import classes from './canvas.module.css'

const CHIP = { width: 88, height: 26 }
const LEGIBLE = 14
const OVER = { position: 'absolute', top: 0, left: 0, zIndex: 5, width: 1, height: 1, overflow: 'visible', pointerEvents: 'none' } as const

const FLOW_ARROWS = { 'flow-arrow': 'var(--flow)', 'flow-arrow-unsure': 'var(--stopped)' }

export function FlowOverlay() {
  const isShown = useDataFlow((s) => s.isShown)
  return isShown ? <Arrows /> : null
}

function Arrows() {
  const { flows, key } = useDataFlow()
  const nodes = useNodes<CanvasNode>()
  const boxes = useMemo(() => nodeBoxes(nodes.filter((node) => node.type !== 'pill' && node.type !== 'rules')), [nodes])
  const links = useMemo(() => drawnLinks(linksOf(flows, key), new Set(boxes.keys())), [flows, key, boxes])
  const chip = useMemo(() => chipOf(boxes), [boxes])
  const hasChip = links.some((link) => link.from === '')
  // With many arrows their words hide more than they say; one key needs none.
  const hasWords = key === undefined && links.length <= LEGIBLE
  const ends = new Set(links.flatMap((link) => [link.from, link.to]))
  return (
    <ViewportPortal>
      <svg className={classes['overlay']} style={OVER} role="img" aria-label={wordsFor(links, key)}>
        <ArrowHeads colours={FLOW_ARROWS} />
        {[...ends].map((path) => {
          const box = boxes.get(path)
          return box && <rect key={path} x={box.x - 4} y={box.y - 4} width={box.width + 8} height={box.height + 8} rx={13} opacity={0.75} />
        })}
        {hasChip && (
          <g transform={`translate(${chip.x} ${chip.y})`} className={classes['chip']}>
            <rect width={chip.width} height={chip.height} rx={13} />
            <text x={chip.width / 2} y={17}>
              behavior
            </text>
          </g>
        )}
        {links.map((link) => {
          const from = link.from === '' ? chip : boxes.get(link.from)
          const to = boxes.get(link.to)
          if (!from || !to) return null
          const { path, middle } = flowCurve(from, to)
          return (
            <g key={`${link.from} ${link.to}`} data-link data-unsure={link.isUnsure || undefined}>
              <path d={path} markerEnd={`url(#flow-arrow${link.isUnsure ? '-unsure' : ''})`} />
              {hasWords && (
                <text x={middle.x} y={middle.y}>
                  {link.key}
                </text>
              )}
            </g>
          )
        })}
      </svg>
    </ViewportPortal>
  )
}

function wordsFor(links: readonly FlowLink[], key: string | undefined): string {
  return `Data flow of ${key ?? 'all keys'}, ${links.length} arrows; the list beside says the same`
}

/** What the behavior itself declares begins above everything else. */
function chipOf(boxes: ReadonlyMap<string, Box>): Box {
  const all = [...boxes.values()]
  const x = Math.min(...all.map((box) => box.x), Infinity)
  const y = Math.min(...all.map((box) => box.y), Infinity)
  return { x: Number.isFinite(x) ? x - 24 : 0, y: (Number.isFinite(y) ? y : 0) - 64, ...CHIP }
}
