/** Takes the next key that is pressed for a command; says whose it is already, and takes it away from there when asked. */
import { Button, Group, Text, TextInput } from '@mantine/core'
import { useState, type KeyboardEvent } from 'react'
import { setKeys, useKeyMap } from '../../api/keyMap'
import { chordOf, chordText, type Chord } from '../../document/chord'
import { chordsOf, conflictOf, refusalOf, type CommandRow } from '../../document/commandTable'

export function KeyField({ row, onDone }: { readonly row: CommandRow; readonly onDone: () => void }) {
  const own = useKeyMap((s) => s.own)
  const [pressed, setPressed] = useState<Chord>()
  const refusal = pressed && refusalOf(pressed)
  const conflict = pressed && !refusal ? conflictOf(row.id, pressed, own) : undefined

  function take(chord: Chord): void {
    setKeys(row.id, [chord])
    onDone()
  }

  function onKeyDown(event: KeyboardEvent): void {
    if (event.key === 'Tab') return
    event.preventDefault()
    event.stopPropagation()
    if (event.key === 'Escape') {
      onDone()
      return
    }
    const chord = chordOf(event)
    if (!chord) return
    setPressed(chord)
    if (!refusalOf(chord) && !conflictOf(row.id, chord, own)) take(chord)
  }

  return (
    <Group gap="xs" pb={6} align="center">
      <TextInput
        size="xs"
        w="8.2rem"
        flex="none"
        data-autofocus
        // oxlint-disable-next-line jsx-a11y/no-autofocus -- it was just asked for, and takes the next key
        autoFocus
        readOnly
        aria-label={`New key: ${row.words}`}
        placeholder="Press a key"
        value={pressed ? chordText(pressed) : ''}
        onKeyDown={onKeyDown}
      />
      <div role="status">
        {refusal && (
          <Text size="xs" c="var(--failed)">
            {refusal}
          </Text>
        )}
        {conflict && (
          <Text size="xs" c="var(--stopped)">
            It is the key of “{conflict.words}”.
          </Text>
        )}
      </div>
      {conflict && pressed && (
        <Button size="compact-xs" flex="none" onClick={() => take(pressed)}>
          Use it here
        </Button>
      )}
      <Button
        size="compact-xs"
        flex="none"
        variant="default"
        disabled={chordsOf(row.id, own).length === 0}
        onClick={() => setKeys(row.id, [])}
      >
        No key
      </Button>
    </Group>
  )
}
