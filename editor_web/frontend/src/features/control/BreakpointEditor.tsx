/** The breakpoints of one node: before its entry and after its outcome, each with condition and count, on or off. */
import { Code, Group, NumberInput, Stack, Switch, Text } from '@mantine/core'
import { useDebouncedValue } from '@mantine/hooks'
import { useEffect, useState } from 'react'
import { editBreakpoints, toggleBreakpoint, useBreakpoints, useSavedBreakpoints } from '../../api/breakpoints'
import { conditionQuery } from '../../api/conditions'
import { useLastAnswer } from '../../api/queryClient'
import { ExpressionInput } from '../../components/ExpressionInput'
import { breakpointWords, matches, replaced, type CompleteBreakpoint } from '../../document/breakpoints'

const PLACES = [
  { when: 'before', group: 'Before its entry', label: 'Pause before its entry' },
  { when: 'after', group: 'After its outcome', label: 'Pause after its outcome' },
] as const

const DELAY_MS = 250

export interface BreakpointEditorProps {
  readonly path: string
  /** Why nothing can be changed. */
  readonly isOff: string | undefined
  /** Where it stands: beside the graph, or at the node in it. */
  readonly place?: 'node' | 'menu'
}

export function BreakpointEditor({ path, isOff, place = 'menu' }: BreakpointEditorProps) {
  const all = useBreakpoints()
  const wide = all.filter((each) => each.path !== path && matches(each.path, path))
  return (
    <Stack gap="2xs" pt="3xs" data-breakpoints={place}>
      {PLACES.map(({ when, group, label }) => {
        const set = all.find((each) => each.path === path && each.when === when)
        return (
          <div key={when} data-when={when} role="group" aria-label={group}>
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

/** Condition and count; they count when the field is left, or with Enter. A condition that the engine refuses is not kept. */
function Details({ point, isOff }: { point: CompleteBreakpoint; isOff: boolean }) {
  const [typed, setTyped] = useState(point.if ?? '')
  const [hits, setHits] = useState<number | string>(point.hits)
  useEffect(() => setTyped(point.if ?? ''), [point.if])
  useEffect(() => setHits(point.hits), [point.hits])
  const behavior = useSavedBreakpoints((s) => s.behavior)
  const [asked] = useDebouncedValue(typed.trim(), DELAY_MS)
  const { value: check } = useLastAnswer({
    ...conditionQuery(behavior, { path: point.path, if: asked, when: point.when }),
    enabled: !isOff,
  })

  function keep(change: Partial<CompleteBreakpoint>): void {
    // With what stands in the other field, of which the answer may be on its way.
    const fresh = { ...point, if: typed.trim() || null, hits: Math.max(1, Number(hits) || 1), ...change }
    if (fresh.if === point.if && fresh.hits === point.hits && fresh.enabled === point.enabled) return
    void editBreakpoints((list) => replaced(list, fresh))
  }

  const keepHits = () => keep({})
  return (
    <Stack gap="3xs" mt="4xs" ml={36}>
      <Group gap="2xs" wrap="nowrap" align="start">
        <ExpressionInput
          label="Only if"
          placeholder="tries > 1"
          value={point.if ?? ''}
          names={check?.names ?? NO_NAMES}
          problem={check?.problem ? [check.problem, check.hint].filter(Boolean).join('; ') : undefined}
          isOff={isOff}
          onType={setTyped}
          onCommit={(text) => keep({ if: text || null })}
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
          onBlur={keepHits}
          onKeyDown={(event) => event.key === 'Enter' && keepHits()}
        />
      </Group>
      <Switch
        size="xs"
        label="Enabled"
        checked={point.enabled}
        disabled={isOff}
        onChange={(event) => keep({ enabled: event.currentTarget.checked })}
      />
    </Stack>
  )
}

const NO_NAMES: readonly string[] = []
