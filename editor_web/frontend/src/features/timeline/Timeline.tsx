/** When each node of a run was active: rows of bars with marks above them, and a cursor that shows any moment of it. */
import { Box } from '@mantine/core'
import { useElementSize } from '@mantine/hooks'
import { IconTimeline } from '@tabler/icons-react'
import { useMemo, useRef, useState, type ReactNode } from 'react'
import { Group, Panel as Pane } from 'react-resizable-panels'
import { backToPresent, seek, seekEvent, useTimeline, type Subject } from '../../api/timeline'
import { useLive } from '../../api/live'
import type { BehaviorView, RunView } from '../../api/types'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { Splitter } from '../../components/Splitter'
import { useIsVisible } from '../../components/useIsVisible'
import type { Mark } from '../../document/measured'
import { isActive } from '../../document/runState'
import {
  afterKey,
  MARK_KINDS,
  neighbor,
  panned,
  revealing,
  rowsOf,
  wholeView,
  zoomed,
  type MarkKind,
  type SharedAxis,
  type View,
} from '../../document/timeline'
import { flatten } from '../../document/tree'
import { depthOf } from '../../document/path'
import { Lanes } from './Lanes'
import classes from './Timeline.module.css'
import { Tools } from './Tools'
import { useDetail } from './useDetail'
import { useMarks } from './useMarks'
import { play, usePlayback } from './usePlayback'
import { useRunTime } from './useRunTime'
import { useRunUpdates, useSubject } from './useSubject'
import { momentWords } from './words'

export interface TimelineProps {
  readonly behavior: BehaviorView
  readonly run: RunView | undefined
  readonly node: string | undefined
  readonly onShow: (path: string) => void
  /** Recorded curves over the same axis of time; the timeline lays them below its lanes. */
  readonly curves?: (subject: Subject, axis: SharedAxis) => ReactNode
}

const MANY_ROWS = 60
/** What the curves stand apart from the right edge, as the lanes do. */
const RIGHT_PX = 10
const KEPT = 'flexcell.timeline.curves'

export function Timeline({ behavior, run, node, onShow, curves }: TimelineProps) {
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
  const [hasCurves, setHasCurves] = useState(() => localStorage.getItem(KEPT) === 'true')
  const [axisPx, setAxisPx] = useState(0)
  const isGoingOn = isActive(run) && !subject?.isPast
  const nowS = useRunTime(course, isShown && isGoingOn)
  const all = useMarks(subject, course?.marks, isShown, isGoingOn)
  usePlayback(subject, nowS)

  const nodes = useMemo(() => new Map(behavior.graph ? flatten(behavior.graph).map((each) => [each.path, each]) : []), [behavior])
  const paths = course?.rows
  const rows = useMemo(() => {
    const known = [...(paths?.keys() ?? [])]
    // Of large behaviors the upper nodes are open at first.
    const shut = known.length > MANY_ROWS ? known.filter((path) => depthOf(path) > 1) : []
    const closed = new Set([...shut.filter((path) => !toggled.has(path)), ...[...toggled].filter((path) => !shut.includes(path))])
    return rowsOf(known, [...nodes.keys()], closed)
  }, [paths, nodes, toggled])
  const marks = useMemo(() => all.marks.filter((mark) => kinds.has(mark.kind as MarkKind)), [all.marks, kinds])
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
    if (mark) goToMark(mark)
  }

  function goToMark(mark: Mark): void {
    // What was measured is no event: the moment is that of its time.
    if (mark.measured) return goTo(mark.time_s)
    seekEvent(of, mark)
    if (chosenView) setView(revealing(chosenView, mark.time_s, nowS))
  }

  function toggleCurves(): void {
    localStorage.setItem(KEPT, String(!hasCurves))
    setHasCurves(!hasCurves)
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

  const onPan = (byS: number) => chosenView && setView(panned(chosenView, byS, nowS))
  const lanes = (
    <Box ref={sized} pos="absolute" inset={0}>
      <Lanes
        rows={rows}
        nodes={nodes}
        spans={spans}
        marks={marks}
        view={view}
        nowS={nowS}
        cursorS={here.timeS}
        isPast={cursorS !== undefined}
        selected={node}
        words={momentWords(here.timeS, nowS, all.marks)}
        onGo={goTo}
        onKey={onKey}
        onZoom={zoom}
        onPan={onPan}
        onShow={onShow}
        onToggle={(path) => setToggled(new Set(toggled.has(path) ? [...toggled].filter((each) => each !== path) : [...toggled, path]))}
        onWidth={setAxisPx}
      />
    </Box>
  )
  const leftPx = width - axisPx - RIGHT_PX
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
          list={{ marks, measured: all.measured, cursorS: here.timeS, onGo: goToMark }}
          curves={curves && { isShown: hasCurves, onToggle: toggleCurves }}
        />
      }
    >
      <Box ref={place} pos="absolute" inset={0}>
        {curves && hasCurves ? (
          <Group orientation="vertical" style={{ height: '100%' }}>
            <Pane id="lanes" defaultSize="40%" minSize="20%" style={{ position: 'relative' }}>
              {lanes}
            </Pane>
            <Splitter isFlat label="Height of the lanes" />
            <Pane id="curves" defaultSize="60%" minSize="20%" style={{ position: 'relative' }}>
              {curves(of, {
                view,
                durationS: nowS,
                leftPx,
                cursorS: here.timeS,
                isGoingOn,
                onGo: goTo,
                onZoom: zoom,
                onPan,
              })}
            </Pane>
          </Group>
        ) : (
          lanes
        )}
      </Box>
    </Panel>
  )
}
