/** Below the field of a named entry: of what kind it is, what is in it, and who changed it last. */
import { Box, Flex, Text } from '@mantine/core'
import { useEffect, useState } from 'react'
import { entries } from '../../api/entries'
import { wordsOf } from '../../api/client'
import { useLive } from '../../api/live'
import type { EntryChanged } from '../../api/types'
import { entryLines, type EntryLine } from '../../document/editing/entryText'
import { wallTime } from '../../document/time'
import { FormWords } from './FormParts'

interface Details {
  readonly of: string
  readonly row: EntryChanged | undefined
  readonly lines: readonly EntryLine[]
}

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
  const [known, setKnown] = useState<Details>()
  const [problem, setProblem] = useState('')
  const of = `${kind} ${name}`
  useEffect(() => {
    let isCurrent = true
    const value = mayCall ? entries.value(kind, name) : Promise.resolve({})
    Promise.all([entries.row(kind, name), value]).then(
      ([row, inside]) => isCurrent && setKnown({ of: `${kind} ${name}`, row, lines: entryLines(kind, inside) }),
      (error: unknown) => isCurrent && setProblem(wordsOf(error)),
    )
    return () => {
      isCurrent = false
    }
  }, [kind, name, mayCall])
  if (problem) return <FormWords>{problem}</FormWords>
  if (known?.of !== of || !known.row) return <FormWords>{known?.of === of ? 'It is not in the store.' : '…'}</FormWords>
  const { row, lines } = known
  const changed = [`revision ${row.revision}`, row.changed_unix_ms > 0 && wallTime(row.changed_unix_ms / 1000), row.by && `by ${row.by}`]
  return (
    <>
      <FormWords>{changed.filter(Boolean).join(', ')}</FormWords>
      {row.tags.length > 0 && <FormWords>{row.tags.join(', ')}</FormWords>}
      {row.reason && <FormWords>{row.reason}</FormWords>}
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
