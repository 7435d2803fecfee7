/** When each node of a run was active: rows of bars with marks above them, and a cursor that shows any moment of it. */
import { Box } from '@mantine/core'
import { useElementSize } from '@mantine/hooks'
import { IconTimeline } from '@tabler/icons-react'
import { useMemo, useRef, useState } from 'react'
import { backToPresent, seek, seekEvent, useTimeline } from '../../api/timeline'
import { useLive } from '../../api/live'
import type { BehaviorView, RunView } from '../../api/types'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { useIsVisible } from '../../components/useIsVisible'
import { isActive } from '../../document/runState'
import {
  afterKey,
  MARK_KINDS,
  neighbor,
  panned,
  placeWords,
  revealing,
  rowsOf,
  wholeView,
  zoomed,
  type MarkKind,
  type View,
} from '../../document/timeline'
import { flatten } from '../../document/tree'
import { depthOf } from '../../document/path'
import { Lanes } from './Lanes'
import classes from './Timeline.module.css'
import { Tools } from './Tools'
import { useDetail } from './useDetail'
import { play, usePlayback } from './usePlayback'
import { useRunTime } from './useRunTime'
import { useRunUpdates, useSubject } from './useSubject'

export interface TimelineProps {
  readonly behavior: BehaviorView
  readonly run: RunView | undefined
  readonly node: string | undefined
  readonly onShow: (path: string) => void
}

const MANY_ROWS = 60

export function Timeline({ behavior, run, node, onShow }: TimelineProps) {
  const place = useRef<HTMLDivElement>(null)
  const isShown = useIsVisible(place)
  const { ref: sized, width } = useElementSize()
  const subject = useSubject(run)
  useRunUpdates(subject, run, isShown)
  const course = useTimeline((s) => s.course)
  const problem = useTimeline((s) => s.problem)
  const cursorS = useTimeline((s) => s.timeS)
  const seq = useLive((s) => s.past?.seq)
  const [kinds, setKinds] = useState<ReadonlySet<MarkKind>>(new Set(MARK_KINDS))
  const [chosenView, setView] = useState<View>()
  const [toggled, setToggled] = useState<ReadonlySet<string>>(new Set())
  const nowS = useRunTime(course, isShown && isActive(run) && !subject?.isPast)
  usePlayback(subject, nowS)

  const order = useMemo(() => (behavior.graph ? flatten(behavior.graph).map((each) => each.path) : []), [behavior])
  const paths = course?.rows
  const rows = useMemo(() => {
    const known = [...(paths?.keys() ?? [])]
    // Of large behaviors the upper nodes are open at first.
    const shut = known.length > MANY_ROWS ? known.filter((path) => depthOf(path) > 1) : []
    const closed = new Set([...shut.filter((path) => !toggled.has(path)), ...[...toggled].filter((path) => !shut.includes(path))])
    return rowsOf(known, order, closed)
  }, [paths, order, toggled])
  const marks = useMemo(() => course?.marks.filter((mark) => kinds.has(mark.kind as MarkKind)) ?? [], [course, kinds])
  const view = chosenView ?? wholeView(nowS)
  const spans = useDetail(subject, course, view, chosenView !== undefined)

  if (!subject || !course) {
    return (
      <Panel title="Timeline">
        <Box ref={place} pos="absolute" inset={0}>
          <Empty
            icon={<IconTimeline size={26} stroke={1.4} aria-hidden />}
            title={problem ? 'The timeline cannot be shown' : run ? 'Reading…' : 'No run yet'}
          >
            {problem || (run ? '' : 'Start the behavior; then see here when each of its nodes was active, and go back to any moment.')}
          </Empty>
        </Box>
      </Panel>
    )
  }
  const of = subject
  const here = { timeS: cursorS ?? nowS, seq: cursorS === undefined ? Infinity : (seq ?? 0) }

  function goTo(timeS: number): void {
    const inside = Math.min(Math.max(timeS, 0), nowS)
    useTimeline.setState({ isPlaying: false })
    seek(of, inside)
    if (chosenView) setView(revealing(chosenView, inside, nowS))
  }

  function jump(direction: 1 | -1, onlyFailures = false): void {
    const mark = neighbor(onlyFailures ? (course?.marks.filter((each) => each.kind === 'failure') ?? []) : marks, here, direction)
    if (!mark) return
    seekEvent(of, mark)
    if (chosenView) setView(revealing(chosenView, mark.time_s, nowS))
  }

  function zoom(factor: number, aroundS = here.timeS): void {
    const next = zoomed(view, factor, Math.min(Math.max(aroundS, view.fromS), view.untilS), nowS)
    setView(next.untilS - next.fromS >= nowS ? undefined : next)
  }

  function onKey(key: string, isFar: boolean): boolean {
    const target = afterKey(key, isFar, here.timeS, view, nowS)
    if (target !== undefined) {
      if (key === 'End') backToPresent(of)
      else goTo(target)
      return true
    }
    const actions: Record<string, () => void> = {
      PageDown: () => jump(1),
      PageUp: () => jump(-1),
      '+': () => zoom(0.5),
      '=': () => zoom(0.5),
      '-': () => zoom(2),
      '0': () => setView(undefined),
      Escape: () => backToPresent(of),
      ' ': () => play(of, nowS),
    }
    actions[key]?.()
    return key in actions
  }

  return (
    <Panel
      title="Timeline"
      className={classes.panel ?? ''}
      tools={
        <Tools
          subject={subject}
          durationS={nowS}
          width={width}
          hasFailures={course.marks.some((mark) => mark.kind === 'failure')}
          kinds={kinds}
          onKinds={setKinds}
          onJump={jump}
          onZoom={zoom}
          onWhole={() => setView(undefined)}
        />
      }
    >
      <Box ref={place} pos="absolute" inset={0}>
        <Box ref={sized} pos="absolute" inset={0}>
          <Lanes
            rows={rows}
            spans={spans}
            marks={marks}
            view={view}
            nowS={nowS}
            cursorS={here.timeS}
            isPast={cursorS !== undefined}
            selected={node}
            words={placeWords(here.timeS, nowS)}
            onGo={goTo}
            onKey={onKey}
            onZoom={zoom}
            onPan={(byS) => chosenView && setView(panned(chosenView, byS, nowS))}
            onShow={onShow}
            onToggle={(path) => setToggled(new Set(toggled.has(path) ? [...toggled].filter((each) => each !== path) : [...toggled, path]))}
          />
        </Box>
      </Box>
    </Panel>
  )
}
