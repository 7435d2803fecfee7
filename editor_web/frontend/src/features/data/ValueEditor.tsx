/** Edits a value of the userdata of a paused run, as JSON, where it stands. */
import { Button, Group, Stack, Textarea } from '@mantine/core'
import { useState, type KeyboardEvent } from 'react'
import { ServerError } from '../../api/client'
import { isJson } from '../../document/schema'
import { kindOfValue } from '../../document/values'

export interface ValueEditorProps {
  readonly name: string
  readonly value: unknown
  /** Sends the new value; rejects with what the server says of it. */
  readonly onSave: (value: unknown) => Promise<unknown>
  readonly onClose: () => void
}

export function ValueEditor({ name, value, onSave, onClose }: ValueEditorProps) {
  const [text, setText] = useState(() => JSON.stringify(value, null, 1))
  const [refusal, setRefusal] = useState('')
  const written: unknown = isJson(text) ? JSON.parse(text) : undefined
  const problem = written === undefined ? 'This is not JSON: a text stands in double quotes' : refusal
  const before = kindOfValue(value)
  const now = kindOfValue(written)

  async function save(): Promise<void> {
    if (written === undefined) return
    try {
      await onSave(written)
      onClose()
    } catch (error) {
      const { message, hint } = error instanceof ServerError ? error.body : { message: String(error), hint: '' }
      setRefusal(hint ? `${message} (${hint})` : message)
    }
  }

  function onKeyDown(event: KeyboardEvent): void {
    if (event.key === 'Escape') onClose()
    else if (event.key === 'Enter' && !event.shiftKey) void save()
    else return
    event.preventDefault()
    event.stopPropagation()
  }

  return (
    <Stack gap={4}>
      <Textarea
        size="xs"
        aria-label={`New value of ${name}`}
        autosize
        maxRows={12}
        // oxlint-disable-next-line jsx-a11y/no-autofocus -- it was just asked for
        autoFocus
        styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
        value={text}
        description={written !== undefined && before !== now ? `It was ${before}; this is ${now}` : undefined}
        error={problem}
        onChange={(event) => {
          setText(event.currentTarget.value)
          setRefusal('')
        }}
        onKeyDown={onKeyDown}
      />
      <Group gap="2xs">
        <Button size="compact-xs" disabled={written === undefined} onClick={() => void save()}>
          Set value
        </Button>
        <Button size="compact-xs" variant="default" onClick={onClose}>
          Cancel
        </Button>
      </Group>
    </Stack>
  )
}
