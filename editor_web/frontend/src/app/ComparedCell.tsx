/** Two runs in one 3D view: the arms of the left run, and those of the right one as ghosts, at the same time of a visit. */
import { Box, Flex, Group, Slider, Switch, Text } from '@mantine/core'
import { IconAlertTriangle } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { showCellAt, usePast } from '../api/past'
import { hasCellView, useSession } from '../api/session'
import type { AlignedVisit } from '../api/types'
import { Notice } from '../components/Notice'
import { alignedMoment } from '../document/comparison'
import { CellFrame } from '../features/cell/CellFrame'

export interface ComparedProps {
  readonly left: string
  readonly right: string
  /** Undefined aligns the runs at their starts. */
  readonly visit: AlignedVisit | undefined
  readonly durationS: number
  readonly cursorS: number | undefined
  readonly onGo: (timeS: number) => void
}

const STEPS = 200

export function ComparedCell({ left, right, visit, durationS, cursorS = 0, onGo }: ComparedProps) {
  const [hasGhost, setHasGhost] = useState(true)
  const isServed = useSession((s) => hasCellView(s.session))
  const problem = usePast((s) => s.shown?.ghost_problem ?? '')
  const moment = alignedMoment(left, right, visit, cursorS)
  const [run, timeS] = moment.solid
  const [other, otherS] = moment.ghost ?? []
  useEffect(() => {
    if (!isServed) return
    showCellAt(run, timeS, hasGhost && other !== undefined && otherS !== undefined ? { run: other, time_s: otherS } : null)
  }, [isServed, run, timeS, hasGhost, other, otherS])
  useEffect(() => () => showCellAt('', null), [])
  return (
    <Flex direction="column" h="100%">
      {isServed && (
        <Group px="md" py="xs" gap="md" wrap="nowrap">
          <Slider
            flex={1}
            size="sm"
            thumbLabel="Time since the start of the visit"
            min={0}
            max={durationS}
            step={durationS / STEPS}
            value={cursorS}
            label={null}
            onChange={onGo}
            thumbProps={{ 'aria-valuetext': `${cursorS.toFixed(2)} s` }}
          />
          <Text span fz="0.78rem" c="dimmed" style={{ fontVariantNumeric: 'tabular-nums', whiteSpace: 'nowrap' }}>
            {cursorS.toFixed(2)} s
          </Text>
          <Switch
            size="xs"
            label="Ghost of the right run"
            disabled={moment.ghost === undefined}
            checked={hasGhost && moment.ghost !== undefined}
            onChange={(event) => setHasGhost(event.currentTarget.checked)}
          />
        </Group>
      )}
      {problem && hasGhost && <Notice icon={<IconAlertTriangle size={16} aria-hidden />}>The right run is not shown: {problem}</Notice>}
      <Box flex={1} mih={0}>
        <CellFrame />
      </Box>
    </Flex>
  )
}
