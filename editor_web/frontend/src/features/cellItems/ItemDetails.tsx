/** One item of the cell: its state now, what the bus tells of it, and its lines of the document. */
import { Alert, Anchor, Button, Code, Group, NativeSelect, ScrollArea, Stack, Table, Text, Title } from '@mantine/core'
import { IconFocus2, IconHandFinger } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { useData } from '../../api/data'
import { lookAt } from '../../api/live'
import { useSession } from '../../api/session'
import type { CellItem, CellItems, MessageFrame } from '../../api/types'
import { Panel } from '../../components/Panel'
import { StatusIcon } from '../../components/StatusIcon'
import { ValueTree } from '../../components/ValueTree'
import { holderOf, orientationText, placeOf, poseOf, positionText, stateWords, type CellNode, type CellNow } from '../../document/cellTree'
import { lookup } from '../../document/dict'

const KINDS: Readonly<Record<CellNode['kind'], string>> = {
  group: 'Group',
  robot: 'Robot',
  tool: 'Tool',
  equipment: 'Equipment',
  device: 'Device',
  bond: 'Bond',
  module: 'Module',
  fixture: 'Fixture',
  part: 'Part',
  camera: 'Camera',
  person: 'Person',
  occupancy: 'Map of occupied space',
  world: 'Simulated world',
  store: 'Store of entries',
  frame: 'Frame',
}

interface ItemDetailsProps {
  readonly node: CellNode
  readonly cell: CellItems
  readonly now: CellNow
  readonly hasCellView: boolean
  readonly onSelect: (address: string) => void
  /** Opens the page on which arms are jogged; undefined for a person who may look only. */
  readonly onTeach: (() => void) | undefined
  /** What is told of a device with a driver, or of a module that may be plugged. */
  readonly device: ReactNode
}

export function ItemDetails({ node, cell, now, hasCellView, onSelect, onTeach, device }: ItemDetailsProps) {
  const place = placeOf(node)
  return (
    <Panel title={node.item ? node.item.path : node.address}>
      <ScrollArea h="100%" viewportProps={{ tabIndex: 0, role: 'region', 'aria-label': `Details of ${node.name}` }}>
        <Stack gap="sm" p="sm">
          <Group gap="xs">
            <Text size="sm">
              {KINDS[node.kind]}
              {node.detail && <Text span c="dimmed">{`, ${node.detail}`}</Text>}
            </Text>
            {place !== undefined && hasCellView && (
              <Button
                size="compact-xs"
                variant="default"
                leftSection={<IconFocus2 size={14} aria-hidden />}
                onClick={() => lookAt([place])}
              >
                Show in 3D
              </Button>
            )}
            {node.kind === 'robot' && onTeach && (
              <Button size="compact-xs" variant="default" leftSection={<IconHandFinger size={14} aria-hidden />} onClick={onTeach}>
                Jog and teach
              </Button>
            )}
          </Group>
          <State node={node} now={now} onSelect={onSelect} />
          {device}
          {node.item && node.item.topics.length > 0 && <Topics key={node.item.path + location.hash} item={node.item} />}
          {node.item && <Lines item={node.item} cell={cell} />}
        </Stack>
      </ScrollArea>
    </Panel>
  )
}

function State({ node, now, onSelect }: Pick<ItemDetailsProps, 'node' | 'now' | 'onSelect'>) {
  const name = node.item?.name ?? ''
  const robot = node.kind === 'robot' ? lookup(now.robots, name) : undefined
  const state = node.kind === 'robot' || node.kind === 'tool' ? stateWords(node, now) : undefined
  const pose = poseOf(node, now.state)
  const holder = node.kind === 'part' ? holderOf(name, now.state) : undefined
  const driven = useSession((s) => s.session)?.devices.find((each) => `robots/${each.device}` === node.item?.path)
  if (!state && !pose && !holder && !driven) return null
  return (
    <Table variant="vertical" withTableBorder tabularNums aria-label={`State of ${node.name}`}>
      <Table.Tbody>
        {state && (
          <Table.Tr>
            <Table.Th w="8rem">State</Table.Th>
            <Table.Td>
              <Group gap={5}>
                {robot && <StatusIcon status={state.look} size={14} />}
                {state.words}
              </Group>
            </Table.Td>
          </Table.Tr>
        )}
        {driven && (
          <Table.Tr>
            <Table.Th>Driver</Table.Th>
            <Table.Td>{driven.simulated ? `simulated instead of ${driven.driver}` : `${driven.driver}, real`}</Table.Td>
          </Table.Tr>
        )}
        {robot?.error && (
          <Table.Tr>
            <Table.Th>Error</Table.Th>
            <Table.Td c="var(--failed)">{robot.error}</Table.Td>
          </Table.Tr>
        )}
        {robot && (
          <Table.Tr>
            <Table.Th>Speed</Table.Th>
            <Table.Td>{Math.round(robot.speed_override * 100)} %</Table.Td>
          </Table.Tr>
        )}
        {holder && (
          <Table.Tr>
            <Table.Th>Held by</Table.Th>
            <Table.Td>
              <Anchor component="button" type="button" size="sm" onClick={() => onSelect(`robots/${holder}`)}>
                {holder}
              </Anchor>
            </Table.Td>
          </Table.Tr>
        )}
        {pose && (
          <>
            <Table.Tr>
              <Table.Th w="8rem">Position</Table.Th>
              <Table.Td>{positionText(pose)}</Table.Td>
            </Table.Tr>
            <Table.Tr>
              <Table.Th>Roll, pitch, yaw</Table.Th>
              <Table.Td>{orientationText(pose)}</Table.Td>
            </Table.Tr>
          </>
        )}
      </Table.Tbody>
    </Table>
  )
}

/** The latest message of one of the topics that tell of an item. */
function Topics({ item }: { readonly item: CellItem }) {
  const [topic, setTopic] = useState(() => firstTopic(item))
  const [latest, setLatest] = useState<MessageFrame>()
  useData({ number: 0, traffic: false, topic, fields: [], run: '', goals: '', cell: false }, (frame) => {
    if (frame.k === 'message') setLatest(frame)
  })
  const shown = latest?.topic === topic ? latest : undefined
  return (
    <section aria-label="Latest message">
      <Stack gap={4}>
        <Group gap="xs" justify="space-between">
          <Title order={3} size="sm">
            Latest message
          </Title>
          <NativeSelect
            size="xs"
            aria-label="Topic"
            data={[...item.topics]}
            value={topic}
            onChange={(event) => setTopic(event.currentTarget.value)}
          />
        </Group>
        {shown?.problem ? (
          <Text size="sm" c="dimmed">
            {shown.problem}
          </Text>
        ) : (
          shown && <ValueTree label={`Message of ${topic}`} value={shown.value} open={1} />
        )}
      </Stack>
    </section>
  )
}

/** The topic of the address, else the one that says what the item does. */
function firstTopic({ topics }: CellItem): string {
  const named = topics.find((topic) => location.hash === `#${topic}`)
  return named ?? topics.find((topic) => /(^|\/)(status|state)$/.test(topic)) ?? topics[0] ?? ''
}

function Lines({ item, cell }: { readonly item: CellItem; readonly cell: CellItems }) {
  const lines = item.text.split('\n')
  return (
    <section aria-label="Document">
      <Stack gap={4}>
        <Title order={3} size="sm">
          {item.line > 0 ? `${item.file || cell.file}, line ${item.line}` : item.file || cell.file}
        </Title>
        {cell.changed && (
          <Alert color="yellow" p="xs">
            The document has changed since the cell was opened. The open cell is as it was; edit the cell to connect it anew.
          </Alert>
        )}
        {item.line > 0 ? (
          <Code block tabIndex={0} role="region" aria-label={`Lines of ${item.name}`}>
            <Group gap="sm" align="start" wrap="nowrap">
              <Text span inherit ta="right" c="var(--quiet)" style={{ userSelect: 'none' }} aria-hidden>
                {lines.map((_, at) => item.line + at).join('\n')}
              </Text>
              <span>{item.text}</span>
            </Group>
          </Code>
        ) : (
          <Text size="sm" c="dimmed">
            The document does not have it any more.
          </Text>
        )}
      </Stack>
    </section>
  )
}
