/** A field for a value that may hold `${…}`: names are offered while one is typed. What is typed counts when the field is left. */
import { Box, Input, Paper, Text } from '@mantine/core'
import { IconChevronDown } from '@tabler/icons-react'
import { useEffect, useId, useRef, useState, type KeyboardEvent } from 'react'
import { completed, openingAt, type Name } from '../../document/editing/completion'
import type { Offer } from '../../document/editing/offers'
import classes from './form.module.css'
import { namesNow } from './useNames'

export interface TemplateInputProps {
  readonly label: string
  readonly value: string
  readonly onCommit: (value: string) => void
  readonly placeholder?: string
  readonly describedBy?: string
  readonly isInvalid?: boolean
  readonly isMono?: boolean
  /** Several lines. */
  readonly isLong?: boolean
  /** More to choose from than names, when the field is empty or holds no `${`; what is said beside one is searched too. */
  readonly options?: readonly (string | Offer)[]
  readonly inputMode?: 'decimal' | 'text'
  /** One of the options is pointed at, before it is taken; undefined when none is any more. */
  readonly onPoint?: (option: string | undefined) => void
}

interface Opened {
  readonly items: readonly (Offer & { readonly name?: Name })[]
  readonly index: number
}

const MOST = 30

export function TemplateInput(props: TemplateInputProps) {
  const { label, value, onCommit, placeholder, describedBy, isInvalid, isMono, isLong, options, inputMode, onPoint } = props
  const [text, setText] = useState(value)
  const [offer, setOffer] = useState<Opened>()
  const field = useRef<HTMLInputElement & HTMLTextAreaElement>(null)
  const id = useId()
  useEffect(() => setText(value), [value])
  // What the mouse is over is not taken by a key.
  const [hovered, setHovered] = useState(-1)
  const at = offer?.items[hovered] ?? offer?.items[offer.index]
  const pointed = at?.name ? undefined : at?.text
  useEffect(() => onPoint?.(pointed), [onPoint, pointed])

  function look(next: string, cursor: number): void {
    setHovered(-1)
    const opening = openingAt(next, cursor, namesNow())
    if (opening) {
      setOffer({
        items: opening.names
          .slice(0, MOST)
          .map((name) => ({ text: name.name, detail: [name.origin, name.detail].filter(Boolean).join(' · '), name })),
        index: 0,
      })
    } else if (options && !next.includes('${')) {
      const query = next.trim().toLowerCase()
      const fitting = options
        .map((option) => (typeof option === 'string' ? { text: option, detail: '' } : option))
        .filter((option) => next === value || `${option.text} ${option.detail}`.toLowerCase().includes(query))
      setOffer(fitting.length > 0 ? { items: fitting.slice(0, MOST), index: -1 } : undefined)
    } else setOffer(undefined)
  }

  function commit(next = text): void {
    setOffer(undefined)
    if (next.trim() !== value) onCommit(next.trim())
  }

  function take(index: number): void {
    const item = offer?.items[index]
    const input = field.current
    if (!item || !input) return
    const opening = item.name ? openingAt(text, input.selectionStart ?? text.length, namesNow()) : undefined
    if (item.name && opening) {
      const done = completed(text, input.selectionStart ?? text.length, opening, item.name.name)
      setText(done.text)
      requestAnimationFrame(() => input.setSelectionRange(done.cursor, done.cursor))
      setOffer(undefined)
    } else {
      setText(item.text)
      commit(item.text)
    }
  }

  function onKeyDown(event: KeyboardEvent): void {
    if (offer && (event.key === 'ArrowDown' || event.key === 'ArrowUp')) {
      event.preventDefault()
      const by = event.key === 'ArrowDown' ? 1 : -1
      setOffer({ ...offer, index: (offer.index + by + offer.items.length) % offer.items.length })
    } else if (offer && offer.index >= 0 && (event.key === 'Enter' || event.key === 'Tab')) {
      event.preventDefault()
      take(offer.index)
    } else if (event.key === 'Enter' && !(isLong && event.shiftKey)) {
      if (!isLong) event.preventDefault()
      if (!isLong) commit()
    } else if (event.key === 'Escape') {
      event.stopPropagation()
      if (offer) setOffer(undefined)
      else {
        setText(value)
        field.current?.blur()
      }
    }
  }

  /** It changes while the list is open. */
  function detailNow(item: Offer): string {
    const option = options?.find((each) => typeof each !== 'string' && each.text === item.text)
    return typeof option === 'object' ? option.detail : item.detail
  }

  const shared = {
    ref: field,
    id,
    size: 'xs',
    withAria: false,
    error: isInvalid,
    ...(isMono ? { style: { '--input-font-family': 'var(--mantine-font-family-monospace)' } } : {}),
    'aria-label': label,
    'aria-invalid': isInvalid ? true : undefined,
    'aria-describedby': describedBy,
    autoComplete: 'off',
    spellCheck: false,
    placeholder,
    value: text,
    onKeyDown,
    onFocus: () => look(text, text.length),
    onBlur: () => commit(),
  }
  return (
    <Box pos="relative" flex={1} miw={0}>
      {isLong ? (
        <Input
          component="textarea"
          multiline
          {...shared}
          rows={Math.min(8, Math.max(2, text.split('\n').length))}
          onChange={(event) => {
            setText(event.currentTarget.value)
            look(event.currentTarget.value, event.currentTarget.selectionStart ?? 0)
          }}
        />
      ) : (
        <Input
          {...shared}
          role="combobox"
          aria-expanded={offer !== undefined}
          aria-controls={`${id}-offer`}
          aria-activedescendant={offer && offer.index >= 0 ? `${id}-${offer.index}` : undefined}
          inputMode={inputMode}
          rightSection={options && options.length > 0 ? <IconChevronDown size={14} aria-hidden /> : undefined}
          rightSectionWidth={24}
          rightSectionPointerEvents="none"
          onChange={(event) => {
            setText(event.currentTarget.value)
            look(event.currentTarget.value, event.currentTarget.selectionStart ?? 0)
          }}
        />
      )}
      {offer && (
        <Paper
          component="ul"
          withBorder
          shadow="md"
          p={4}
          className={`${classes['offer']} plain-list`}
          role="listbox"
          id={`${id}-offer`}
          aria-label={`Choices for ${label}`}
          onPointerLeave={() => setHovered(-1)}
        >
          {offer.items.map((item, index) => (
            <li
              className="pick-row"
              key={item.text}
              id={`${id}-${index}`}
              role="option"
              aria-selected={index === offer.index}
              onPointerEnter={() => setHovered(index)}
              onPointerDown={(event) => {
                event.preventDefault()
                take(index)
              }}
            >
              <span>{item.text}</span>
              <Text span inherit c="dimmed" ta="right">
                {detailNow(item)}
              </Text>
            </li>
          ))}
          {offer.items.length === 0 && (
            <li role="option" aria-selected={false} aria-disabled>
              No such name
            </li>
          )}
        </Paper>
      )}
    </Box>
  )
}
