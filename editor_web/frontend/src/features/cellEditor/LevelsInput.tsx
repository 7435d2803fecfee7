/** Outputs or sensors, each on, off or not named. */
import { Group, NativeSelect, Text, TextInput } from '@mantine/core'
import { useState } from 'react'
import { fieldsOf, lookup, without } from '../../document/dict'

interface LevelsInputProps {
  readonly label: string
  readonly choices: readonly string[]
  /** Other names can be given too. */
  readonly isOpen: boolean
  readonly value: unknown
  readonly onChange: (value: unknown) => void
}

const LEVELS = ['–', 'on', 'off']

export function LevelsInput({ label, choices, isOpen, value, onChange }: LevelsInputProps) {
  const levels = fieldsOf(value)
  const names = [...new Set([...choices, ...Object.keys(levels)])]
  const set = (name: string, level: string) => {
    const next = level === '–' ? without(levels, name) : { ...levels, [name]: level === 'on' }
    onChange(Object.keys(next).length === 0 && !isOpen ? undefined : next)
  }
  return (
    <Group gap="xs" role="group" aria-label={label}>
      <Text size="xs">{label}</Text>
      {names.map((name) => (
        <NativeSelect
          key={name}
          size="xs"
          aria-label={`${label} ${name}`}
          leftSection={
            <Text span size="xs" c="dimmed" truncate px={4}>
              {name}
            </Text>
          }
          leftSectionWidth={24 + 6.5 * name.length}
          data={LEVELS}
          value={wordOf(lookup(levels, name))}
          onChange={(event) => set(name, event.currentTarget.value)}
        />
      ))}
      {isOpen && <OtherName label={`Other of ${label}`} onName={(name) => set(name, 'on')} />}
      {names.length === 0 && !isOpen && (
        <Text size="xs" c="dimmed">
          no sensors: its time only
        </Text>
      )}
    </Group>
  )
}

function wordOf(level: unknown): string {
  return level === undefined ? '–' : level === true ? 'on' : 'off'
}

function OtherName({ label, onName }: { readonly label: string; readonly onName: (name: string) => void }) {
  const [name, setName] = useState('')
  const take = () => {
    if (/^[a-z][a-z0-9_]{0,63}$/.test(name)) onName(name)
    setName('')
  }
  return (
    <TextInput
      size="xs"
      w="7rem"
      aria-label={label}
      placeholder="other output"
      value={name}
      onChange={(event) => setName(event.currentTarget.value)}
      onBlur={take}
      onKeyDown={(event) => {
        if (event.key !== 'Enter') return
        event.preventDefault()
        take()
      }}
    />
  )
}
