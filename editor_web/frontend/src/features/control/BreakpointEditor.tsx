/** The breakpoints of one node: before its entry and after its outcome, each with condition and count. */
import { Code, Group, NumberInput, Stack, Switch, Text, TextInput, UnstyledButton, VisuallyHidden } from '@mantine/core'
import { useEffect, useState } from 'react'
import { editBreakpoints, toggleBreakpoint, useBreakpoints } from '../../api/breakpoints'
import { breakpointWords, matches, replaced, type CompleteBreakpoint } from '../../document/breakpoints'

const PLACES = [
  { when: 'before', label: 'Pause before its entry' },
  { when: 'after', label: 'Pause after its outcome' },
] as const

export function BreakpointEditor({ path, isOff }: { path: string; isOff: string | undefined }) {
  const all = useBreakpoints()
  const wide = all.filter((each) => each.path !== path && matches(each.path, path))
  return (
    <Stack gap="2xs" pt="3xs">
      {PLACES.map(({ when, label }) => {
        const set = all.find((each) => each.path === path && each.when === when)
        return (
          <div key={when}>
            <Switch
              size="xs"
              label={label}
              checked={set !== undefined}
              disabled={isOff !== undefined}
              onChange={() => void toggleBreakpoint(path, when)}
            />
            {set && <Details point={set} isOff={isOff !== undefined} />}
          </div>
        )
      })}
      {wide.map((each) => (
        <Text key={`${each.path}${each.when}`} size="xs" c="var(--quiet)">
          Also by <Code>{each.path}</Code>: {breakpointWords(each)}
        </Text>
      ))}
    </Stack>
  )
}

/** Condition and count; they count when the field is left, or with Enter. */
function Details({ point, isOff }: { point: CompleteBreakpoint; isOff: boolean }) {
  const [condition, setCondition] = useState(point.if ?? '')
  const [hits, setHits] = useState<number | string>(point.hits)
  useEffect(() => {
    setCondition(point.if ?? '')
    setHits(point.hits)
  }, [point.if, point.hits])

  function keep(): void {
    const fresh = { ...point, if: condition.trim() || null, hits: Math.max(1, Number(hits) || 1) }
    if (fresh.if === point.if && fresh.hits === point.hits) return
    void editBreakpoints((list) => replaced(list, fresh))
  }

  return (
    <Group
      component="form"
      gap="2xs"
      mt="4xs"
      ml={36}
      wrap="nowrap"
      onSubmit={(event) => {
        event.preventDefault()
        keep()
      }}
    >
      <TextInput
        size="xs"
        label="Only if"
        placeholder="tries > 1"
        flex={1}
        styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
        value={condition}
        disabled={isOff}
        onChange={(event) => setCondition(event.currentTarget.value)}
        onBlur={keep}
      />
      <NumberInput
        size="xs"
        label="From time"
        min={1}
        allowDecimal={false}
        w={84}
        value={hits}
        disabled={isOff}
        onChange={setHits}
        onBlur={keep}
      />
      <VisuallyHidden>
        <UnstyledButton type="submit" tabIndex={-1}>
          Keep
        </UnstyledButton>
      </VisuallyHidden>
    </Group>
  )
}
