/** Curves of chosen numbers of topics: joints, forces, widths, over the last two minutes. */
import { Box, Button, Group, SegmentedControl, Text } from '@mantine/core'
import { IconChartLine, IconDownload, IconListTree, IconPhotoDown, IconPlayerPauseFilled, IconPlayerPlayFilled } from '@tabler/icons-react'
import { useMemo, useRef, useState } from 'react'
import { busQueries } from '../../api/bus'
import { useAnswer } from '../../api/queryClient'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { useIsVisible } from '../../components/useIsVisible'
import { csvOf } from '../../document/curves'
import { wallTime } from '../../document/time'
import { saveBlob } from '../../components/saveBlob'
import { headingsOf, savePicture } from './exporting'
import { coloured, describe } from './fields'
import { FieldChooser } from './FieldChooser'
import { Legend } from './Legend'
import { PlotCanvas } from './PlotCanvas'
import { SPANS_S, usePlot } from './usePlot'
import type { TopicFields } from '../../api/types'
import classes from './plots.module.css'

const NONE: readonly TopicFields[] = []

export function Plots() {
  const area = useRef<HTMLDivElement>(null)
  const isShown = useIsVisible(area)
  const plot = usePlot(isShown)
  const { value, problem } = useAnswer({ ...busQueries.fields(), enabled: isShown })
  const topics = value?.topics
  const [atS, setAtS] = useState<number>()
  const [isChoosing, setChoosing] = useState(true)
  const colors = useRef<ReadonlyMap<string, number>>(new Map())
  const entries = useMemo(() => {
    colors.current = coloured(colors.current, plot.chosen)
    return plot.chosen.map((id) => ({ id, color: colors.current.get(id) ?? 0, ...describe(id, topics ?? NONE) }))
  }, [plot.chosen, topics])

  const stamp = () => new Date().toISOString().slice(0, 19).replaceAll(':', '')
  const save = () => saveBlob(new Blob([csvOf(plot.curves, headingsOf(entries))], { type: 'text/csv' }), `curves-${stamp()}.csv`)
  const canvas = useRef<HTMLCanvasElement>(null)

  const isPaused = plot.pausedS !== undefined
  const tools = (
    <Group gap="2xs" wrap="nowrap" flex={1} miw={0}>
      <Button
        size="compact-xs"
        variant={isChoosing ? 'light' : 'subtle'}
        aria-pressed={isChoosing}
        leftSection={<IconListTree size={14} aria-hidden />}
        onClick={() => setChoosing(!isChoosing)}
      >
        Choose
      </Button>
      <Text span flex={1} truncate fz="0.78rem" c="dimmed" style={{ fontVariantNumeric: 'tabular-nums' }}>
        {atS !== undefined ? wallTime(atS) : isPaused ? `paused at ${wallTime(plot.pausedS ?? 0)}` : ''}
        {plot.dropped > 0 && <span title="This page was too slow for them"> {plot.dropped} samples missing</span>}
      </Text>
      <SegmentedControl
        size="xs"
        aria-label="Time shown"
        data={SPANS_S.map((span) => ({ value: String(span), label: span < 60 ? `${span} s` : `${span / 60} min` }))}
        value={String(SPANS_S.find((span) => span === plot.spanS) ?? '')}
        onChange={(span) => plot.zoom(Number(span))}
      />
      <Button
        size="compact-xs"
        variant="default"
        disabled={entries.length === 0}
        leftSection={isPaused ? <IconPlayerPlayFilled size={12} aria-hidden /> : <IconPlayerPauseFilled size={12} aria-hidden />}
        onClick={isPaused ? plot.goOn : plot.pause}
      >
        {isPaused ? 'Go on' : 'Hold'}
      </Button>
      <Button
        size="compact-xs"
        variant="default"
        disabled={entries.length === 0}
        leftSection={<IconDownload size={14} aria-hidden />}
        onClick={save}
      >
        CSV
      </Button>
      <Button
        size="compact-xs"
        variant="default"
        disabled={entries.length === 0}
        leftSection={<IconPhotoDown size={14} aria-hidden />}
        onClick={() => canvas.current && savePicture(canvas.current, entries, `curves-${stamp()}.png`)}
      >
        PNG
      </Button>
    </Group>
  )

  function body() {
    if (problem) return <Empty title="There are no numbers to plot">{problem}</Empty>
    if (!topics) return <div role="status" aria-label="Loading" />
    if (topics.length === 0) {
      return (
        <Empty icon={<IconChartLine size={26} stroke={1.4} aria-hidden />} title="There is nothing to plot yet">
          The robots of a cell publish numbers: serve one with <code>flexcell serve --cell FILE</code>.
        </Empty>
      )
    }
    return (
      <div className={classes.halves} data-choosing={isChoosing || undefined}>
        {isChoosing && <FieldChooser topics={topics} chosen={plot.chosen} onChoose={plot.choose} />}
        {entries.length === 0 ? (
          <Empty icon={<IconChartLine size={26} stroke={1.4} aria-hidden />} title="Nothing is selected">
            Unfold a topic and tick what you want to see: joints, forces, widths.
          </Empty>
        ) : (
          <div className={classes.main}>
            <PlotCanvas canvas={canvas} plot={plot} curves={entries} atS={atS} onPoint={setAtS} />
            <Legend
              entries={entries}
              curves={plot.curves}
              atS={atS}
              endS={plot.pausedS}
              onRemove={(id) => plot.choose(plot.chosen.filter((each) => each !== id))}
            />
          </div>
        )}
      </div>
    )
  }

  return (
    <Panel title="Plots" tools={tools}>
      <Box pos="absolute" inset={0} className={classes.plots} ref={area}>
        {body()}
      </Box>
    </Panel>
  )
}

/** What can be plotted, asked for again while it is looked at. */
