/** Curves of a recorded run, or of two over one another, with the cursor that the whole page shares. */
import { Box, Button, Group, Text } from '@mantine/core'
import { IconArrowsMaximize, IconChartLine, IconDownload, IconListTree, IconPhotoDown } from '@tabler/icons-react'
import { useRef, useState } from 'react'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { useIsVisible } from '../../components/useIsVisible'
import { panned, wholeView, zoomed, type View } from '../../document/timeline'
import { savePicture } from './exporting'
import { FieldChooser } from './FieldChooser'
import { keptFields } from './keptFields'
import { Legend } from './Legend'
import type { RecordedSource } from './recorded'
import { RecordedCanvas } from './RecordedCanvas'
import { useRecordedPlot } from './useRecordedPlot'
import classes from './plots.module.css'

export interface RecordedPlotsProps {
  readonly sources: readonly RecordedSource[]
  /** From 0 to here in the time of the plot. */
  readonly durationS: number
  readonly cursorS: number | undefined
  readonly onGo: (timeS: number) => void
}

export function RecordedPlots({ sources, durationS, cursorS, onGo }: RecordedPlotsProps) {
  const area = useRef<HTMLDivElement>(null)
  const canvas = useRef<HTMLCanvasElement>(null)
  const isShown = useIsVisible(area)
  const [part, setPart] = useState<View>()
  const [width, setWidth] = useState(0)
  const view = part ?? wholeView(durationS)
  const plot = useRecordedPlot(sources, isShown, view, width)
  const { topics, problem, entries, curves } = plot
  const [isChoosing, setChoosing] = useState(() => keptFields().length === 0)

  function zoom(factor: number, aroundS: number): void {
    const next = Number.isFinite(factor) ? zoomed(view, factor, aroundS, durationS) : wholeView(durationS)
    setPart(next.untilS - next.fromS >= durationS ? undefined : next)
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
      <Button
        size="compact-xs"
        variant="default"
        disabled={isEmpty}
        leftSection={<IconDownload size={14} aria-hidden />}
        onClick={plot.saveCsv}
      >
        CSV
      </Button>
      <Button
        size="compact-xs"
        variant="default"
        disabled={isEmpty}
        leftSection={<IconPhotoDown size={14} aria-hidden />}
        onClick={() => canvas.current && savePicture(canvas.current, entries, 'recorded-curves.png')}
      >
        PNG
      </Button>
    </Group>
  )

  function body() {
    if (problem) return <Empty title="There are no recorded curves">{problem}</Empty>
    if (!topics) return <div role="status" aria-label="Loading" />
    return (
      <div className={classes.halves} data-choosing={isChoosing || undefined}>
        {isChoosing && <FieldChooser topics={topics} chosen={plot.chosen} onChoose={plot.choose} />}
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
            <Legend entries={entries} curves={curves} atS={cursorS} endS={undefined} onRemove={plot.remove} />
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
