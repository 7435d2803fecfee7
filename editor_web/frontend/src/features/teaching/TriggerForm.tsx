/** Makes or changes one trigger, in the words of the Helping Hand. */
import { Group, NativeSelect, Paper, SimpleGrid, TextInput } from '@mantine/core'
import { useState } from 'react'
import { useTeach } from '../../api/teaching'
import type { Trigger } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { CALLBACK_WORDS, TYPE_WORDS } from './triggerWords'

interface TriggerFormProps {
  readonly arms: readonly string[]
  readonly trigger: Trigger
  /** Names of the other triggers. */
  readonly taken: readonly string[]
  readonly onKeep: (trigger: Trigger) => void
  readonly onCancel: () => void
}

export function TriggerForm({ arms, trigger, taken, onKeep, onCancel }: TriggerFormProps) {
  const frames = useTeach((s) => s.frames)
  const [made, setMade] = useState(trigger)
  const [value, setValue] = useState(JSON.stringify(trigger.trig_value))
  const fault = !made.trig_name
    ? 'give it a name'
    : taken.includes(made.trig_name)
      ? 'another trigger has this name'
      : !made.trig_topic
        ? 'name a topic'
        : ''

  function set(part: Partial<Trigger>): void {
    setMade({ ...made, ...part })
  }

  return (
    <Paper
      component="form"
      withBorder
      bg="transparent"
      p="sm"
      aria-label="Trigger"
      onSubmit={(event) => {
        event.preventDefault()
        if (!fault) onKeep({ ...made, trig_value: valueOf(value) })
      }}
    >
      <SimpleGrid minColWidth="13em" spacing="sm" verticalSpacing="xs">
        <TextInput
          size="xs"
          label="Name"
          value={made.trig_name}
          maxLength={80}
          error={made.trig_name !== '' && fault}
          onChange={(event) => set({ trig_name: event.currentTarget.value })}
        />
        <NativeSelect
          size="xs"
          label="Arm"
          value={made.robot_ns}
          onChange={(event) => set({ robot_ns: event.currentTarget.value })}
          data={[{ value: '', label: 'the only one' }, ...new Set([...arms, made.robot_ns].filter(Boolean))]}
        />
        <TextInput
          size="xs"
          label="Topic"
          value={made.trig_topic}
          maxLength={200}
          onChange={(event) => set({ trig_topic: event.currentTarget.value })}
          spellCheck={false}
        />
        <TextInput
          size="xs"
          label="Field"
          placeholder="the usual one"
          value={made.field}
          onChange={(event) => set({ field: event.currentTarget.value })}
          spellCheck={false}
        />
        <NativeSelect
          size="xs"
          label="Type"
          value={made.trig_type}
          onChange={(event) => set({ trig_type: event.currentTarget.value as Trigger['trig_type'] })}
          data={optionsOf(TYPE_WORDS)}
        />
        <TextInput size="xs" label="Value" value={value} onChange={(event) => setValue(event.currentTarget.value)} spellCheck={false} />
        <NativeSelect
          size="xs"
          label="Callback"
          value={made.trig_callback}
          onChange={(event) => set({ trig_callback: event.currentTarget.value as Trigger['trig_callback'] })}
          data={optionsOf(CALLBACK_WORDS)}
        />
        {made.trig_callback === 'tf_save' && (
          <>
            <datalist id="frames">
              {['world', ...frames].map((each) => (
                <option key={each} value={each} />
              ))}
            </datalist>
            <TextInput
              size="xs"
              label="Source frame"
              list="frames"
              value={made.source_frame}
              onChange={(event) => set({ source_frame: event.currentTarget.value })}
            />
            <TextInput
              size="xs"
              label="Target frame"
              list="frames"
              value={made.target_frame}
              onChange={(event) => set({ target_frame: event.currentTarget.value })}
            />
          </>
        )}
      </SimpleGrid>
      <Group gap="xs" mt="xs">
        <CommandButton
          label="Keep the trigger"
          tone="strong"
          obstacle={fault || undefined}
          onPress={() => onKeep({ ...made, trig_value: valueOf(value) })}
        />
        <CommandButton label="Cancel" tone="quiet" onPress={onCancel} />
      </Group>
    </Paper>
  )
}

function optionsOf(words: Readonly<Record<string, string>>): { value: string; label: string }[] {
  return Object.entries(words).map(([value, label]) => ({ value, label: `${value}: ${label}` }))
}

/** true, false, a number, or the text itself. */
function valueOf(typed: string): Trigger['trig_value'] {
  try {
    const read: unknown = JSON.parse(typed)
    return typeof read === 'boolean' || typeof read === 'number' || typeof read === 'string' ? read : typed
  } catch {
    return typed
  }
}
