/** Measures from one item of the cell to another: what is selected is the second one. */
import { ActionIcon, Button, Group, Stack, Table, Text } from '@mantine/core'
import { IconRuler2, IconX } from '@tabler/icons-react'
import { useEffect } from 'react'
import { connectTeach, useTeach } from '../../api/teaching'
import { showMarks } from '../../api/viewMarks'
import { measuredBetween } from '../../document/cellMeasure'
import { positionText } from '../../document/cellTree'
import { NO_TURN, type PlacedPose, type Vector } from '../../document/poses'
import { degrees } from '../../document/teaching'

export interface MeasuredItem {
  readonly address: string
  readonly name: string
  readonly pose: PlacedPose
}

interface MeasureProps {
  readonly from: MeasuredItem | undefined
  readonly to: MeasuredItem | undefined
  readonly onFrom: (address: string) => void
}

export function Measure({ from, to, onFrom }: MeasureProps) {
  const isBetween = from !== undefined && to !== undefined && from.address !== to.address
  usePointsInView(isBetween ? [from.pose.xyz, to.pose.xyz] : undefined)
  if (!from) {
    return (
      <Button
        size="compact-xs"
        variant="default"
        m="xs"
        leftSection={<IconRuler2 size={14} aria-hidden />}
        disabled={!to}
        title={to ? '' : 'select an item that has a place'}
        onClick={() => to && onFrom(to.address)}
      >
        Measure from here
      </Button>
    )
  }
  const found = isBetween ? measuredBetween(from.pose, to.pose) : undefined
  return (
    <Stack component="section" gap={4} p="xs" aria-label="Measured" style={{ borderTop: '1px solid var(--line)' }}>
      <Group gap={4} wrap="nowrap">
        <Text size="sm" fw={600} flex={1} truncate>
          {found ? `${from.name} to ${to?.name}` : `From ${from.name}: select another item`}
        </Text>
        <ActionIcon variant="subtle" color="gray" aria-label="End measuring" onClick={() => onFrom('')}>
          <IconX size={14} aria-hidden />
        </ActionIcon>
      </Group>
      {found && (
        <Table variant="vertical" withTableBorder tabularNums aria-label="Distance and angle">
          <Table.Tbody>
            <Row name="Distance" value={`${found.distance_m.toFixed(4)} m`} />
            <Row name="In the world" value={axes(found.world_m)} />
            <Row name={`Along ${from.name}`} value={axes(found.own_m)} />
            <Row name="Angle" value={`${degrees(found.angle_rad).toFixed(2)}°`} />
          </Table.Tbody>
        </Table>
      )}
    </Stack>
  )
}

function Row({ name, value }: { readonly name: string; readonly value: string }) {
  return (
    <Table.Tr>
      <Table.Th w="8rem">{name}</Table.Th>
      <Table.Td>{value}</Table.Td>
    </Table.Tr>
  )
}

function axes(xyz: Vector): string {
  return positionText({ xyz, xyzw: NO_TURN, frame: '' })
}

const BY = 'measured'

/** Both ends in the 3D view of this page. */
function usePointsInView(points: readonly Vector[] | undefined): void {
  const isOpen = useTeach((s) => s.isOpen)
  const written = JSON.stringify(points ?? null)
  useEffect(connectTeach, [])
  useEffect(() => {
    const marked = JSON.parse(written) as readonly Vector[] | null
    if (!isOpen || !marked) return
    showMarks(BY, { points: marked })
    return () => showMarks(BY, undefined)
  }, [isOpen, written])
}
