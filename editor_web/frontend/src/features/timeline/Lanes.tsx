/** The ruler with its marks, the names, the bars and the cursor; drawn on canvases, moved by pointer, wheel and keys. */
import { Box, Flex, Paper, useComputedColorScheme } from '@mantine/core'
import { useElementSize } from '@mantine/hooks'
import { useEffect, useRef, useState, type KeyboardEvent } from 'react'
import type { ActivationInterval, GraphNode } from '../../api/types'
import { rowOf, type Mark } from '../../document/measured'
import { spanAt, timeAt, xOf, type ShownRow, type View } from '../../document/timeline'
import { cleared, colorsOf, drawBars, drawHead, HEAD, ROW } from './draw'
import { drawMeasured } from './drawMeasured'
import { Names } from './Names'
import classes from './Timeline.module.css'
import { markWords, spanWords } from './words'
import { useGestures } from './useGestures'

export interface LanesProps {
  readonly rows: readonly ShownRow[]
  /** The nodes of the graph by path. */
  readonly nodes: ReadonlyMap<string, GraphNode>
  readonly spans: ReadonlyMap<string, readonly ActivationInterval[]>
  readonly marks: readonly Mark[]
  readonly view: View
  readonly nowS: number
  readonly cursorS: number
  readonly isPast: boolean
  readonly selected: string | undefined
  /** Where the cursor is, for screen readers. */
  readonly words: string
  readonly onGo: (timeS: number) => void
  readonly onKey: (key: string, isFar: boolean) => boolean
  readonly onZoom: (factor: number, aroundS: number) => void
  readonly onPan: (byS: number) => void
  readonly onShow: (path: string) => void
  readonly onToggle: (path: string) => void
  /** How wide the axis of time is. */
  readonly onWidth: (width: number) => void
}

interface Tip {
  readonly x: number
  readonly y: number
  readonly lines: readonly string[]
}

const NEAR_PX = 4

export function Lanes(props: LanesProps) {
  const { rows, spans, marks, view, nowS, cursorS, isPast, selected } = props
  const { ref: area, width, height } = useElementSize<HTMLDivElement>()
  const scheme = useComputedColorScheme('light')
  const head = useRef<HTMLCanvasElement>(null)
  const bars = useRef<HTMLCanvasElement>(null)
  const whole = useRef<HTMLDivElement>(null)
  const scroller = useRef<HTMLDivElement>(null)
  const [topPx, setTop] = useState(0)
  const [tip, setTip] = useState<Tip>()

  useEffect(() => {
    const [onHead, onBars] = [head.current, bars.current]
    if (!onHead || !onBars || width === 0) return
    const colors = colorsOf(onHead)
    const font = getComputedStyle(onHead).fontFamily
    const first = cleared(onHead, width, HEAD)
    if (first) drawHead(first, view, width, marks, colors, font)
    const second = cleared(onBars, width, height)
    if (!second) return
    drawBars(second, view, width, height, { rows, spans, selected, nowS, topPx }, colors, font)
    drawMeasured(second, view, { width, height }, { rows, marks, topPx }, colors, font)
  }, [rows, spans, marks, view, width, height, nowS, topPx, selected, scheme])

  const { onWidth } = props
  useEffect(() => onWidth(width), [width, onWidth])

  useEffect(() => {
    // A pinch would zoom the whole page; React cannot keep it from that.
    const keep = (event: WheelEvent) => event.ctrlKey && event.preventDefault()
    const on = whole.current
    on?.addEventListener('wheel', keep, { passive: false })
    return () => on?.removeEventListener('wheel', keep)
  }, [])

  const nearS = (NEAR_PX / Math.max(width, 1)) * (view.untilS - view.fromS)

  /** The time of the mark that is pressed, but for goals, which are everywhere. */
  function snapped(timeS: number): number {
    const near = marks.filter((mark) => mark.kind !== 'goal' && Math.abs(mark.time_s - timeS) <= nearS)
    return near.toSorted((a, b) => Math.abs(a.time_s - timeS) - Math.abs(b.time_s - timeS))[0]?.time_s ?? timeS
  }

  function pointed(x: number, y: number, isHead: boolean): readonly string[] | undefined {
    const timeS = timeAt(view, width, x)
    const index = Math.floor((y + topPx) / ROW)
    const near = marks.filter((mark) => Math.abs(mark.time_s - timeS) <= nearS * 1.5)
    if (isHead) {
      // What matters more than a goal is named first.
      const named = near.toSorted((a, b) => Number(a.kind === 'goal') - Number(b.kind === 'goal')).slice(0, 4)
      return named.length > 0 ? [...named.map(markWords), ...(near.length > 4 ? [`and ${near.length - 4} more`] : [])] : undefined
    }
    const measured = near.filter((mark) => mark.measured && rowOf(rows, mark.path) === index)
    if (measured.length > 0) return measured.map(markWords)
    const row = rows[index]
    const span = row && spanAt(spans.get(row.path) ?? [], timeS, nearS)
    return row && span && spanWords(row.path, span, nowS)
  }

  function onHover(x: number, y: number, isHead: boolean): void {
    const lines = pointed(x, y, isHead)
    setTip(lines && { x, y: isHead ? y : y + HEAD, lines })
  }

  const gestures = useGestures({
    view,
    width,
    snapped,
    onGo: props.onGo,
    onZoom: props.onZoom,
    onPan: props.onPan,
    onHover,
    onLeave: () => setTip(undefined),
  })

  function onKeyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || !props.onKey(event.key, event.shiftKey)) return
    event.preventDefault()
    // The keys of the page mean something else.
    event.stopPropagation()
  }

  const cursorX = xOf(view, width, cursorS)
  return (
    <Box pos="absolute" inset={0} fz="0.8rem" className={classes.lanes} data-past={isPast || undefined} ref={whole}>
      <Flex align="center" px="xs" fw={620} className={classes.corner}>
        {cursorS.toFixed(2)} s
      </Flex>
      <div
        className={classes.head}
        role="slider"
        tabIndex={0}
        aria-label="Moment of the run"
        aria-valuemin={0}
        aria-valuemax={Math.round(nowS * 100) / 100}
        aria-valuenow={Math.round(cursorS * 100) / 100}
        aria-valuetext={props.words}
        title="Drag to see a moment of the past; turn the wheel to zoom"
        onKeyDown={onKeyDown}
        {...gestures.head}
      >
        <canvas ref={head} aria-hidden />
      </div>
      <div className={classes.rows} ref={scroller} onScroll={(event) => setTop(event.currentTarget.scrollTop)}>
        <Box pos="relative" h={rows.length * ROW}>
          <Names
            rows={rows}
            nodes={props.nodes}
            spans={spans}
            selected={selected}
            cursorS={cursorS}
            topPx={topPx}
            heightPx={height}
            onShow={props.onShow}
            onToggle={props.onToggle}
          />
        </Box>
      </div>
      <div className={classes.bars} ref={area} {...gestures.bars(scroller)}>
        <canvas ref={bars} aria-hidden />
      </div>
      <div className={classes.over} aria-hidden>
        {cursorX >= 0 && cursorX <= width && <div className={classes.cursor} style={{ transform: `translateX(${cursorX}px)` }} />}
        {tip && (
          <Paper
            withBorder
            shadow="md"
            radius="sm"
            px="xs"
            py={4}
            pos="absolute"
            maw="min(44ch, 70%)"
            bg="var(--raised)"
            style={{
              overflowWrap: 'anywhere',
              left: tip.x,
              top: tip.y,
              transform: `translate(${tip.x > width / 2 ? 'calc(-100% - 12px)' : '12px'}, ${tip.y < HEAD + 40 ? '12px' : 'calc(-100% - 8px)'})`,
            }}
          >
            {tip.lines.map((line, index) => (
              <div key={index}>{line}</div>
            ))}
          </Paper>
        )}
      </div>
    </Box>
  )
}
