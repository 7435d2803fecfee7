/** The changes of an entry, each with what it was then. */
import { Anchor, Flex, Paper, Stack, Text, Title } from '@mantine/core'
import { IconEye } from '@tabler/icons-react'
import { useState } from 'react'
import { entryQueries } from '../../api/entries'
import { useAnswer } from '../../api/queryClient'
import { previewTaught } from '../../api/teaching'
import type { EntryChanged, EntryRecord } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { changesOf, degrees } from '../../document/teaching'
import { wallTime } from '../../document/time'
import { useFits } from './Comparison'
import { Facts } from './Facts'
import { PLAYED } from './forms'
import { poseWords } from './poseWords'
import { Refusal } from '../../components/Refusal'

const MOST_SHOWN = 1200

export function EntryHistory({ arm, entry }: { readonly arm: string; readonly entry: EntryChanged }) {
  const [opened, setOpened] = useState<number>()
  const { value } = useAnswer(entryQueries.history(entry.kind, entry.name))
  const history = value?.changes ?? []
  return (
    <>
      <Title order={4} size="xs">
        History
      </Title>
      <Flex
        component="ol"
        direction="column"
        gap={4}
        m={0}
        p={0}
        fz="sm"
        style={{ listStyle: 'none' }}
        aria-label={`History of ${entry.name}`}
      >
        {history.toReversed().map((change) => {
          const words = `${change.deleted ? 'deleted' : change.revision === 1 ? 'made' : 'changed'}${change.by && ` by ${change.by}`}, ${wallTime(change.changed_unix_ms / 1000)}`
          return (
            <li key={change.revision}>
              {change.deleted ? (
                <Revision number={change.revision} words={words} />
              ) : (
                <Anchor
                  component="button"
                  type="button"
                  inherit
                  aria-expanded={opened === change.revision}
                  title="Value at that time"
                  onClick={() => setOpened(opened === change.revision ? undefined : change.revision)}
                >
                  <Revision number={change.revision} words={words} />
                </Anchor>
              )}
              {change.reason && (
                <Text span inherit c="dimmed">
                  {' '}
                  – {change.reason}
                </Text>
              )}
              {opened === change.revision && <Was arm={arm} entry={entry} revision={change.revision} />}
            </li>
          )
        })}
      </Flex>
    </>
  )
}

interface WasProps {
  readonly arm: string
  readonly entry: EntryChanged
  readonly revision: number
}

function Was({ arm, entry, revision }: WasProps) {
  const { kind, name } = entry
  const hasPlace = PLAYED.has(kind)
  const { value: was, problem } = useAnswer(entryQueries.revision(kind, name, revision))
  const then = { kind, name, capture: 0, revision }
  const now = { ...then, revision: entry.revision }
  const { fits, problem: unfit } = useFits(
    hasPlace
      ? [
          { key: 'then', label: name, arm, what: then },
          { key: 'now', label: name, arm, what: now },
        ]
      : [],
  )
  const [before, after] = [fits.then, fits.now].map((fit) => fit?.demonstration ?? fit?.primitive ?? undefined)
  const joints = before?.joints.at(-1)
  const pose = before?.poses.at(-1)
  const isMotion = (before?.poses.length ?? 0) > 1
  return (
    <Paper withBorder bg="transparent" p="xs" my={4} role="group" aria-label={`Revision ${revision} of ${name}`}>
      <Stack gap="xs" align="flex-start">
        <Facts
          facts={[
            joints && {
              name: isMotion ? 'Ends at joints' : 'Joints',
              value: joints.map((value) => `${degrees(value).toFixed(1)}°`).join('  '),
              isCode: true,
            },
            pose && { name: isMotion ? 'Ends at pose' : 'Pose', value: poseWords(pose), isCode: true },
            !hasPlace && was && { name: 'Value', value: valueWords(was), isCode: true },
            was?.tags && was.tags.length > 0 && { name: 'Tags', value: was.tags.join(', ') },
            before && after && revision !== entry.revision && { name: 'Brought back', value: changesOf(after, before).join(', ') },
          ]}
        />
        <Refusal>{problem || unfit}</Refusal>
        {hasPlace && (
          <CommandButton
            label="Show this one in the cell"
            icon={<IconEye size={15} aria-hidden />}
            onPress={() => previewTaught(arm, then)}
          />
        )}
      </Stack>
    </Paper>
  )
}

function Revision({ number, words }: { readonly number: number; readonly words: string }) {
  return (
    <>
      <Text span inherit ff="monospace">
        {number}
      </Text>{' '}
      {words}
    </>
  )
}

function valueWords({ value }: EntryRecord): string {
  const text = JSON.stringify(value, undefined, 1)
  return text.length > MOST_SHOWN ? `${text.slice(0, MOST_SHOWN)} …` : text
}
