/** What both the draft and the file have changed: a side for each field, and then all else of both is saved with it. */
import { Button, Code, Group, Paper, SegmentedControl, Stack, Table, Text, Title } from '@mantine/core'
import { IconGitMerge } from '@tabler/icons-react'
import type { NodeConflict } from '../../api/types'
import { TextButton } from '../../components/TextButton'
import { nodeOf } from '../../document/editing/model'
import { nameOfPath } from '../../document/path'
import { keyOf, reveal, saveChosen } from './session'
import { rootOf, setEditor, useEditor } from './store'

export function ConflictPanel() {
  const conflicts = useEditor((s) => s.conflict?.merge?.conflicts)
  const sides = useEditor((s) => s.sides)
  if (!conflicts) return null
  const open = conflicts.filter((each) => !(keyOf(each) in sides)).length
  const choose = (chosen: readonly NodeConflict[], side: NodeConflict['side']) =>
    setEditor({ sides: { ...sides, ...Object.fromEntries(chosen.map((each) => [keyOf(each), side])) } })
  return (
    <Paper
      component="section"
      aria-label="Conflicts"
      px="md"
      py="xs"
      radius={0}
      bg="var(--stopped-soft)"
      mah="40%"
      style={{ overflow: 'auto' }}
    >
      <Stack gap="2xs">
        <Group gap="2xs">
          <IconGitMerge size={16} aria-hidden />
          <Title order={2} size="sm">
            <span role="status">
              The file has changed: {conflicts.length} {conflicts.length === 1 ? 'conflict' : 'conflicts'}, {open} open
            </span>
          </Title>
          <Text size="xs" c="var(--quiet)">
            All other changes of both are merged. The side that is not selected stays in the history of versions.
          </Text>
        </Group>
        <Table aria-label="Conflicts" verticalSpacing={2} horizontalSpacing="xs" fz="sm">
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Node</Table.Th>
              <Table.Th>Field</Table.Th>
              <Table.Th>Was</Table.Th>
              <Table.Th>Mine or theirs</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {conflicts.map((each) => (
              <ConflictRow key={keyOf(each)} conflict={each} side={sides[keyOf(each)]} onChoose={(side) => choose([each], side)} />
            ))}
          </Table.Tbody>
        </Table>
        <Group gap="2xs">
          <Button size="compact-sm" disabled={open > 0} onClick={() => void saveChosen()}>
            Save with these choices
          </Button>
          <Button size="compact-sm" variant="default" onClick={() => choose(conflicts, 'mine')}>
            All mine
          </Button>
          <Button size="compact-sm" variant="default" onClick={() => choose(conflicts, 'theirs')}>
            All theirs
          </Button>
          <Button size="compact-sm" variant="default" onClick={() => setEditor({ isComparing: true })}>
            Compare the texts
          </Button>
          <Button size="compact-sm" variant="subtle" color="gray" onClick={() => setEditor({ conflict: undefined, isOutdated: true })}>
            Go on editing
          </Button>
        </Group>
      </Stack>
    </Paper>
  )
}

interface ConflictRowProps {
  readonly conflict: NodeConflict
  readonly side: NodeConflict['side'] | undefined
  readonly onChoose: (side: NodeConflict['side']) => void
}

function ConflictRow({ conflict, side, onChoose }: ConflictRowProps) {
  const { path, field } = conflict
  const isNode = useEditor((s) => nodeOf(rootOf(s), path) !== undefined)
  const what = field || 'the whole node'
  return (
    <Table.Tr data-conflict={keyOf(conflict)} data-side={side}>
      <Table.Td>
        {isNode ? (
          <TextButton label={`${path}, ${what}`} onPress={() => reveal(path)}>
            {nameOfPath(path)}
          </TextButton>
        ) : (
          nameOfPath(path)
        )}
      </Table.Td>
      <Table.Td>{what}</Table.Td>
      <Table.Td>
        <Value value={conflict.base} />
      </Table.Td>
      <Table.Td>
        <SegmentedControl
          size="xs"
          aria-label={`${nameOfPath(path)}, ${what}`}
          value={side ?? ''}
          data={[
            { value: 'mine', label: <Value value={conflict.mine} by="Mine" /> },
            { value: 'theirs', label: <Value value={conflict.theirs} by="Theirs" /> },
          ]}
          onChange={(chosen) => onChoose(chosen as NodeConflict['side'])}
        />
      </Table.Td>
    </Table.Tr>
  )
}

const LONGEST = 48

/** A value as it is written; of a node only that it is there. */
function Value({ value, by }: { readonly value: unknown; readonly by?: string }) {
  const text = value === null || value === undefined ? 'removed' : JSON.stringify(value)
  return (
    <span title={text}>
      {by && `${by}: `}
      <Code fz="xs">{text.length > LONGEST ? `${text.slice(0, LONGEST)}…` : text}</Code>
    </span>
  )
}
