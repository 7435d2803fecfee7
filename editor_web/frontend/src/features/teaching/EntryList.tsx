/** The named entries of the cell: found, and laid beside each other. */
import { Badge, Checkbox, Flex, Group, NativeSelect, Stack, Text, TextInput, UnstyledButton } from '@mantine/core'
import { useDebouncedValue } from '@mantine/hooks'
import { useState } from 'react'
import { entryQueries } from '../../api/entries'
import { useLastAnswer, type Answer } from '../../api/queryClient'
import type { EntryPage, EntryChanged } from '../../api/types'
import { Empty } from '../../components/Empty'
import classes from './Choices.module.css'
import { Comparison, MOST_COMPARED, type Compared } from './Comparison'
import { EntryDetails } from './EntryDetails'
import { PLAYED } from './forms'
import { Part } from './Part'
import { Refusal } from '../../components/Refusal'

const KINDS = ['joints', 'pose', 'dmp', 'cart_dmp', 'trajectory', 'gripper', 'cart_offsets', 'record']
const TYPING_MS = 150

export function EntryList({ arm }: { readonly arm: string }) {
  const [text, setText] = useState('')
  const [kind, setKind] = useState('')
  const [chosen, setChosen] = useState('')
  const [compared, setCompared] = useState<readonly string[]>([])
  const { value: page, problem } = useEntries(kind, text)
  const one = page?.entries.find((each) => keyOf(each) === chosen)
  const beside = page?.entries.filter((each) => compared.includes(keyOf(each))) ?? []
  return (
    <Stack gap="xs">
      <Group wrap="nowrap" gap="xs">
        <TextInput
          flex={1}
          size="xs"
          label="Search"
          placeholder="name or tag"
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
          autoComplete="off"
        />
        <NativeSelect
          w="9em"
          size="xs"
          label="Kind"
          value={kind}
          onChange={(event) => setKind(event.currentTarget.value)}
          data={[{ value: '', label: 'all' }, ...KINDS]}
        />
      </Group>
      <Refusal>{problem}</Refusal>
      {page && page.entries.length === 0 ? (
        <Empty title={text || kind ? 'Nothing is found' : 'No entries yet'}>
          {text || kind ? 'Search for the beginning of a word of the name or of a tag.' : 'Capture something and save it under a name.'}
        </Empty>
      ) : (
        <ul className={`${classes.list} plain-list`} aria-label="Entries">
          {page?.entries.map((each) => (
            <li key={keyOf(each)}>
              <Checkbox
                size="xs"
                aria-label={`Compare ${keyOf(each)}`}
                title="Compare"
                checked={compared.includes(keyOf(each))}
                disabled={!PLAYED.has(each.kind) || (beside.length >= MOST_COMPARED && !compared.includes(keyOf(each)))}
                onChange={(event) =>
                  setCompared(event.currentTarget.checked ? [...compared, keyOf(each)] : compared.filter((key) => key !== keyOf(each)))
                }
              />
              <UnstyledButton flex={1} miw={0} py={6} pr="xs" aria-pressed={keyOf(each) === chosen} onClick={() => setChosen(keyOf(each))}>
                <Flex component="span" gap={4} align="center">
                  <Text span size="sm" c="dimmed" w="6em">
                    {each.kind}
                  </Text>
                  <Text span size="sm" fw={560} flex={1} truncate>
                    {each.name}
                  </Text>
                  {each.tags.map((tag) => (
                    <Badge key={tag} component="span" variant="default" size="sm" tt="none" fw={500}>
                      {tag}
                    </Badge>
                  ))}
                </Flex>
              </UnstyledButton>
            </li>
          ))}
        </ul>
      )}
      {page && page.total > page.entries.length && (
        <Text size="sm" c="dimmed">
          The first {page.entries.length} of {page.total}; search to see others.
        </Text>
      )}
      {beside.length > 0 && (
        <Part label="Comparison" title="Side by side">
          {beside.length < 2 && (
            <Text size="sm" c="dimmed">
              Choose another one to compare it with.
            </Text>
          )}
          <Comparison things={beside.map((each) => asCompared(each, arm))} />
        </Part>
      )}
      {one && <EntryDetails key={keyOf(one)} arm={arm} entry={one} />}
    </Stack>
  )
}

function keyOf(entry: EntryChanged): string {
  return `${entry.kind} ${entry.name}`
}

/** As it is at its revision, so that a change is asked for anew. */
function asCompared({ kind, name, revision }: EntryChanged, arm: string): Compared {
  return { key: `${kind} ${name}`, label: name, arm, what: { kind, name, capture: 0, revision } }
}

function useEntries(kind: string, text: string): Answer<EntryPage> {
  const [typed] = useDebouncedValue(text, TYPING_MS)
  return useLastAnswer(entryQueries.found(kind, typed))
}
