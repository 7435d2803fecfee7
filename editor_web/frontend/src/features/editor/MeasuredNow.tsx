/** What a robot measures now, beside the value that is set for it. */
import { Group, Progress, Text } from '@mantine/core'
import { useState } from 'react'
import { useData } from '../../api/data'
import { lookup, type Dict } from '../../document/dict'
import type { EditField } from '../../document/editing/fields'

interface MeasuredNowProps {
  readonly field: EditField
  readonly value: unknown
  readonly arm: string
}

export function MeasuredNow({ field, value, arm }: MeasuredNowProps) {
  const [message, setMessage] = useState<{ readonly of: string; readonly value: unknown; readonly problem: string }>()
  const topic = arm ? `${arm}/${field.measuredOn}` : ''
  useData(topic ? { number: 0, traffic: false, topic, fields: [], run: '', goals: '', cell: false } : undefined, (frame) => {
    if (frame.k === 'message') setMessage({ of: frame.topic, value: frame.value, problem: frame.problem })
  })
  const now = message?.of === topic ? message : undefined
  const measured = measuredOf(field.name, now?.value)
  const words = measured === undefined ? (obstacle(arm, now?.problem) ?? 'Nothing is measured yet') : measuredWords(measured, field.unit)
  const share = measured && shareOf(measured, value ?? field.fallback)
  return (
    <Group gap="xs" wrap="nowrap" mt={4}>
      <Text size="xs" role="status" aria-label={`Measured for ${field.name}`} style={{ fontVariantNumeric: 'tabular-nums' }}>
        {words}
      </Text>
      {share !== undefined && <Progress flex={1} size="sm" value={share} color={share >= 100 ? 'red' : 'accent'} aria-hidden />}
    </Group>
  )
}

function obstacle(arm: string, problem: string | undefined): string | undefined {
  if (!arm) return 'Choose the robot first: it says whose force is shown'
  return problem ? `Nothing is measured: ${problem}` : undefined
}

/** The quantity of this name in a message, else its force. */
function measuredOf(name: string, message: unknown): readonly number[] | undefined {
  if (typeof message !== 'object' || message === null) return undefined
  const fields = message as Dict<unknown>
  const found = lookup(fields, name) ?? lookup(fields, 'force_n')
  const numbers = Array.isArray(found) ? (found as unknown[]) : [found]
  return numbers.every((each) => typeof each === 'number') ? numbers : undefined
}

function measuredWords(measured: readonly number[], unit: string): string {
  const size = Math.hypot(...measured).toFixed(1)
  if (measured.length === 1) return `Now ${measured[0]?.toFixed(1)} ${unit}`
  return `Now ${size} ${unit} (${measured.map((each) => each.toFixed(1)).join(', ')})`
}

/** How much of what is set is measured, in percent. */
function shareOf(measured: readonly number[], value: unknown): number | undefined {
  const numbers = Array.isArray(value) ? (value as unknown[]) : [value]
  if (!numbers.every((each) => typeof each === 'number')) return undefined
  const set = Math.hypot(...numbers)
  return set > 0 ? Math.min(100, (Math.hypot(...measured) / set) * 100) : undefined
}
