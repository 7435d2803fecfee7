/** A slider whose value counts when it is let go; until the server has taken it, it stays where it was put. */
import { Group, Text } from '@mantine/core'
import { useEffect, useId, useRef, useState } from 'react'

const PATIENCE_MS = 1500

/** Where it was put; open until it is let go. */
interface Edit {
  readonly value: number
  readonly isOpen: boolean
}

export interface CommitSliderProps {
  readonly label: string
  /** Whose it is, for screen readers, where a page has several. */
  readonly of?: string
  readonly value: number
  readonly min: number
  readonly max: number
  readonly step: number
  /** The value in words, also for screen readers. */
  readonly words: (value: number) => string
  /** False when the server refused; the slider goes back. */
  readonly onCommit: (value: number) => Promise<boolean>
  /** Why it cannot be moved now. */
  readonly obstacle?: string | undefined
  readonly hint?: string | undefined
}

export function CommitSlider({ label, of, value, min, max, step, words, onCommit, obstacle, hint }: CommitSliderProps) {
  const id = useId()
  const [edit, setEdit] = useState<Edit>()
  /** One after the other, so that the value put last is the one that holds. */
  const queue = useRef<Promise<boolean>>(Promise.resolve(true))
  const shown = edit?.value ?? value

  useEffect(() => {
    if (edit === undefined || edit.isOpen) return
    if (edit.value === value) {
      setEdit(undefined)
      return
    }
    // What was sent comes back by another way than the answer; after a while the server is right whatever it says.
    const patience = setTimeout(() => setEdit(undefined), PATIENCE_MS)
    return () => clearTimeout(patience)
  }, [edit, value])

  function commit(): void {
    if (!edit?.isOpen) return
    const sent = { value: edit.value, isOpen: false }
    setEdit(sent)
    queue.current = queue.current.then(() => onCommit(sent.value))
    void queue.current.then((taken) => !taken && setEdit((now) => (now === sent ? undefined : now)))
  }

  return (
    <Group gap="2xs" wrap="nowrap" fz="0.82rem" title={obstacle ? `Not possible: ${obstacle}` : hint}>
      <Text component="label" htmlFor={id} inherit c="var(--label, var(--quiet))">
        {label}
      </Text>
      <input
        style={{ width: '6.5rem', accentColor: 'var(--accent)' }}
        id={id}
        type="range"
        min={min}
        max={max}
        step={step}
        value={shown}
        disabled={obstacle !== undefined}
        aria-label={of === undefined ? undefined : `${label} of ${of}`}
        aria-valuetext={words(shown)}
        onChange={(event) => setEdit({ value: Number(event.currentTarget.value), isOpen: true })}
        onPointerUp={commit}
        onKeyUp={commit}
        onBlur={commit}
      />
      <Text component="output" htmlFor={id} inherit miw="2.6em" fw={600} style={{ fontVariantNumeric: 'tabular-nums' }}>
        {words(shown)}
      </Text>
    </Group>
  )
}
