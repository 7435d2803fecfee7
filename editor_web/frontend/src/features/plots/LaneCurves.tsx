/** Recorded curves below the lanes of a timeline: one axis of time, one cursor. */
import { Box, Button, Flex, Group, Popover, Text } from '@mantine/core'
import { IconDownload, IconListTree, IconPhotoDown } from '@tabler/icons-react'
import { useRef, useState } from 'react'
import { useIsVisible } from '../../components/useIsVisible'
import type { SharedAxis } from '../../document/timeline'
import { savePicture } from './exporting'
import { FieldChooser } from './FieldChooser'
import { LegendLine } from './LegendLine'
import { settledPart, type RecordedSource } from './recorded'
import { RecordedCanvas } from './RecordedCanvas'
import { useRecordedPlot } from './useRecordedPlot'
import classes from './plots.module.css'

interface LaneCurvesProps {
  readonly sources: readonly RecordedSource[]
  readonly axis: SharedAxis
}

export function LaneCurves({ sources, axis }: LaneCurvesProps) {
  const area = useRef<HTMLDivElement>(null)
  const canvas = useRef<HTMLCanvasElement>(null)
  const isShown = useIsVisible(area)
  const [width, setWidth] = useState(0)
  const [isChoosing, setChoosing] = useState(false)
  const { view, cursorS } = axis
  const plot = useRecordedPlot(sources, isShown, axis.isGoingOn ? settledPart(view, axis.durationS) : view, width)
  const { entries, curves, topics, problem } = plot
  const isEmpty = entries.length === 0
  return (
    <Box pos="absolute" inset={0} className={classes.plots} ref={area}>
      <Flex direction="column" h="100%">
        <Group gap="2xs" wrap="nowrap" px="xs" pt={2} role="toolbar" aria-label="Curves">
          <Popover opened={isChoosing} onChange={setChoosing} position="top-start" width={320} shadow="md" trapFocus returnFocus>
            <Popover.Target>
              <Button
                size="compact-xs"
                variant={isChoosing ? 'light' : 'subtle'}
                aria-expanded={isChoosing}
                disabled={!topics}
                leftSection={<IconListTree size={14} aria-hidden />}
                onClick={() => setChoosing(!isChoosing)}
              >
                Choose curves
              </Button>
            </Popover.Target>
            <Popover.Dropdown p={0} mah={320} style={{ overflow: 'auto' }}>
              {isChoosing && topics && <FieldChooser topics={topics} chosen={plot.chosen} onChoose={plot.choose} />}
            </Popover.Dropdown>
          </Popover>
          {isEmpty || problem ? (
            <Text span flex={1} truncate fz="0.78rem" c="dimmed">
              {problem || (topics ? 'Nothing is selected' : '')}
            </Text>
          ) : (
            <LegendLine entries={entries} curves={curves} atS={cursorS} />
          )}
          <Button
            size="compact-xs"
            variant="subtle"
            disabled={isEmpty}
            leftSection={<IconDownload size={14} aria-hidden />}
            onClick={plot.saveCsv}
          >
            CSV
          </Button>
          <Button
            size="compact-xs"
            variant="subtle"
            disabled={isEmpty}
            leftSection={<IconPhotoDown size={14} aria-hidden />}
            onClick={() => canvas.current && savePicture(canvas.current, entries, 'recorded-curves.png')}
          >
            PNG
          </Button>
        </Group>
        {!isEmpty && (
          <RecordedCanvas
            canvas={canvas}
            curves={curves}
            shown={entries}
            view={view}
            cursorS={cursorS}
            leftPx={axis.leftPx}
            onGo={axis.onGo}
            onZoom={axis.onZoom}
            onPan={axis.onPan}
            onWidth={setWidth}
          />
        )}
      </Flex>
    </Box>
  )
}
