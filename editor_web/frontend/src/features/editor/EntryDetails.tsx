/** Below the field of a named entry: of what kind it is, what is in it, and who changed it last. */
import { Box, Flex, Text } from '@mantine/core'
import { useState } from 'react'
import { entryQueries } from '../../api/entries'
import { useLive } from '../../api/live'
import { useAnswer } from '../../api/queryClient'
import { findUsages } from '../../api/usages'
import { TextButton } from '../../components/TextButton'
import { entryLines } from '../../document/editing/entryText'
import { wallTime } from '../../document/time'
import { FormWords } from './FormParts'

export function EntryDetails({ kind, name }: { kind: string; name: string }) {
  const [isOpen, setOpen] = useState(false)
  return (
    <Box component="details" fz="xs" mt={3} data-entry onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>
        About {name}{' '}
        <Text span inherit c="dimmed">
          {kind}
        </Text>
      </summary>
      {isOpen && <Inside kind={kind} name={name} />}
    </Box>
  )
}

/** Fetched only when somebody looks. */
function Inside({ kind, name }: { kind: string; name: string }) {
  const mayCall = useLive((s) => s.role === 'operator')
  const { value: row, problem: noRow } = useAnswer(entryQueries.row(kind, name))
  const { value: inside, problem: noValue } = useAnswer({ ...entryQueries.value(kind, name), enabled: mayCall })
  const problem = noRow ?? noValue
  if (problem) return <FormWords>{problem}</FormWords>
  if (row === undefined || (mayCall && inside === undefined)) return <FormWords>…</FormWords>
  if (row === null) return <FormWords>It is not in the store.</FormWords>
  const lines = entryLines(kind, inside ?? {})
  const changed = [`revision ${row.revision}`, row.changed_unix_ms > 0 && wallTime(row.changed_unix_ms / 1000), row.by && `by ${row.by}`]
  return (
    <>
      <FormWords>{changed.filter(Boolean).join(', ')}</FormWords>
      {row.tags.length > 0 && <FormWords>{row.tags.join(', ')}</FormWords>}
      {row.reason && <FormWords>{row.reason}</FormWords>}
      <TextButton onPress={() => findUsages({ kind: 'entry', name })}>Find usages</TextButton>
      <Box component="dl" m={0}>
        {lines.map((line) => (
          <Flex key={line.label} justify="space-between" gap="xs">
            <Text component="dt" inherit c="dimmed">
              {line.label}
            </Text>
            <Box component="dd" m={0} ff="monospace">
              {line.words}
            </Box>
          </Flex>
        ))}
      </Box>
    </>
  )
}
