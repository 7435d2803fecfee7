/** A field for an expression: the names that it can use are offered while one is typed, and what is wrong with it is said below. */
import { Autocomplete, Text } from '@mantine/core'
import { useEffect, useRef, useState } from 'react'
import { found } from '../document/editing/search'

export interface ExpressionInputProps {
  readonly label: string
  readonly isLabelHidden?: boolean
  readonly placeholder?: string
  readonly value: string
  readonly names: readonly string[]
  /** What is wrong with what was typed. */
  readonly problem?: string | undefined
  readonly isOff?: boolean
  readonly isFocused?: boolean
  /** What is typed now, before it counts. */
  readonly onType?: (text: string) => void
  /** It counts when the field is left, or with Enter. */
  readonly onCommit: (text: string) => void
  readonly onCancel?: () => void
}

const MOST = 12
const WORD = /[A-Za-z_][A-Za-z0-9_]*$/

export function ExpressionInput(props: ExpressionInputProps) {
  const { label, isLabelHidden, placeholder, value, names, problem, isOff = false, isFocused, onType, onCommit, onCancel } = props
  const [text, setText] = useState(value)
  const [cursor, setCursor] = useState<number>()
  const field = useRef<HTMLInputElement>(null)
  const isCancelled = useRef(false)
  useEffect(() => setText(value), [value])
  useEffect(() => {
    if (isFocused) field.current?.focus()
  }, [isFocused])

  const before = cursor === undefined ? '' : text.slice(0, cursor)
  const word = WORD.exec(before)?.[0] ?? ''
  const offered = word === '' ? [] : found(names, word, (name) => [name]).filter((name) => name !== word)
  // An option is the whole text as it is with the name in it; the list shows the names.
  const options = new Map(
    offered.slice(0, MOST).map((name) => [before.slice(0, before.length - word.length) + name + text.slice(before.length), name]),
  )

  function type(next: string): void {
    setText(next)
    setCursor(options.has(next) ? undefined : (field.current?.selectionStart ?? next.length))
    onType?.(next)
  }

  return (
    <Autocomplete
      ref={field}
      size="xs"
      flex={1}
      miw={0}
      {...(isLabelHidden ? { 'aria-label': label } : { label })}
      placeholder={placeholder ?? ''}
      value={text}
      error={problem}
      disabled={isOff}
      data={[...options.keys()]}
      filter={({ options: all }) => all}
      renderOption={({ option }) => (
        <Text span size="xs" ff="monospace">
          {options.get(option.value) ?? option.value}
        </Text>
      )}
      autoComplete="off"
      spellCheck={false}
      styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
      onChange={type}
      onKeyDown={(event) => {
        if (event.key === 'Enter' && !event.defaultPrevented && !event.nativeEvent.isComposing) {
          if (event.currentTarget.getAttribute('aria-activedescendant')) return
          onCommit(text.trim())
        } else if (event.key === 'Escape' && (text !== value || onCancel)) {
          event.stopPropagation()
          isCancelled.current = true
          setText(value)
          onType?.(value)
          field.current?.blur()
        }
      }}
      onBlur={() => {
        if (isCancelled.current) onCancel?.()
        else onCommit(text.trim())
        isCancelled.current = false
      }}
    />
  )
}
