/** Curves of a recorded run, or of two over one another, with the cursor that the whole page shares. */
import { Box, Button, Group, Text } from '@mantine/core'
import { IconArrowsMaximize, IconChartLine, IconDownload, IconListTree, IconPhotoDown } from '@tabler/icons-react'
import { useCallback, useMemo, useRef, useState } from 'react'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { useIsVisible } from '../../components/useIsVisible'
import { csvOf } from '../../document/curves'
import { panned, wholeView, zoomed, type View } from '../../document/timeline'
import { saveBlob, savePicture } from './exporting'
import { coloured, describe } from './fields'
import { FieldChooser } from './FieldChooser'
import { keptFields, keepFields } from './keptFields'
import { Legend } from './Legend'
import { curveId, type RecordedSource } from './recorded'
import { RecordedCanvas } from './RecordedCanvas'
import { useRecordedCurves, useRecordedFields } from './useRecordedCurves'
import classes from './plots.module.css'

export interface RecordedPlotsProps {
  readonly sources: readonly RecordedSource[]
  /** From 0 to here in the time of the plot. */
  readonly durationS: number
  readonly cursorS: number | undefined
  readonly onGo: (timeS: number) => void
}

/** Colours of the second source are those of the first, dashed. */
const DASHED = 8

export function RecordedPlots({ sources, durationS, cursorS, onGo }: RecordedPlotsProps) {
  const area = useRef<HTMLDivElement>(null)
  const canvas = useRef<HTMLCanvasElement>(null)
  const isShown = useIsVisible(area)
  const { topics, problem } = useRecordedFields(sources, isShown)
  const [chosen, setChosen] = useState(keptFields)
  const [isChoosing, setChoosing] = useState(chosen.length === 0)
  const [part, setPart] = useState<View>()
  const [width, setWidth] = useState(0)
  const view = part ?? wholeView(durationS)
  const known = useMemo(
    () => chosen.filter((id) => topics?.some((topic) => topic.fields.some((field) => `${topic.topic}:${field.path}` === id))),
    [chosen, topics],
  )
  const { curves, problem: lost } = useRecordedCurves(sources, isShown ? known : [], view, Math.min(1000, Math.round(width / 2)))
  const entries = useMemo(() => {
    const colors = coloured(new Map(), known)
    return known.flatMap((field) =>
      sources.map((source, index) => {
        const { topic, label, unit } = describe(field, topics ?? [])
        return {
          id: curveId(source, field),
          topic,
          label: source.label ? `${source.label} ${label}` : label,
          unit,
          color: ((colors.get(field) ?? 0) % DASHED) + (index > 0 ? DASHED : 0),
        }
      }),
    )
  }, [known, sources, topics])
  const choose = useCallback((fields: readonly string[]) => {
    setChosen(fields)
    keepFields(fields)
  }, [])

  function zoom(factor: number, aroundS: number): void {
    const next = Number.isFinite(factor) ? zoomed(view, factor, aroundS, durationS) : wholeView(durationS)
    setPart(next.untilS - next.fromS >= durationS ? undefined : next)
  }

  function saveCsv(): void {
    const headings = Object.fromEntries(entries.map(({ id, topic, label, unit }) => [id, `${topic} ${label}${unit && ` (${unit})`}`]))
    saveBlob(new Blob([csvOf(curves, headings)], { type: 'text/csv' }), 'recorded-curves.csv')
  }

  const isEmpty = entries.length === 0
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
        {cursorS !== undefined && `${cursorS.toFixed(2)} s`}
      </Text>
      <Button
        size="compact-xs"
        variant="default"
        disabled={!part}
        leftSection={<IconArrowsMaximize size={13} aria-hidden />}
        onClick={() => setPart(undefined)}
      >
        Whole
      </Button>
      <Button size="compact-xs" variant="default" disabled={isEmpty} leftSection={<IconDownload size={14} aria-hidden />} onClick={saveCsv}>
        CSV
      </Button>
      <Button
        size="compact-xs"
        variant="default"
        disabled={isEmpty}
        leftSection={<IconPhotoDown size={14} aria-hidden />}
        onClick={() => canvas.current && savePicture(canvas.current, 'recorded-curves.png')}
      >
        PNG
      </Button>
    </Group>
  )

  function body() {
    if (problem || lost) return <Empty title="There are no recorded curves">{problem || lost}</Empty>
    if (!topics) return <div role="status" aria-label="Loading" />
    return (
      <div className={classes.halves} data-choosing={isChoosing || undefined}>
        {isChoosing && <FieldChooser topics={topics} chosen={known} onChoose={choose} />}
        {isEmpty ? (
          <Empty icon={<IconChartLine size={26} stroke={1.4} aria-hidden />} title="Nothing is selected">
            Unfold a topic and tick what you want to see: joints, forces, widths.
          </Empty>
        ) : (
          <div className={classes.main}>
            <RecordedCanvas
              canvas={canvas}
              curves={curves}
              shown={entries}
              view={view}
              cursorS={cursorS}
              onGo={(timeS) => onGo(Math.min(Math.max(timeS, 0), durationS))}
              onZoom={zoom}
              onPan={(byS) => part && setPart(panned(part, byS, durationS))}
              onWidth={setWidth}
            />
            <Legend
              entries={entries}
              curves={curves}
              atS={cursorS}
              endS={undefined}
              {...(sources.length === 1 && { onRemove: (id: string) => choose(chosen.filter((each) => each !== id)) })}
            />
          </div>
        )}
      </div>
    )
  }

  return (
    <Panel title="Recorded curves" tools={tools}>
      <Box pos="absolute" inset={0} className={classes.plots} ref={area}>
        {body()}
      </Box>
    </Panel>
  )
}
