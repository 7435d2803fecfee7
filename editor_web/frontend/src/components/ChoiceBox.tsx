/** A box to choose from by typing: a field and a list below it, worked by the arrow keys. */
import { Input, Kbd, Text } from '@mantine/core'
import { useEffect, useId, useRef, useState, type KeyboardEvent, type ReactNode } from 'react'
import { fit, found } from '../document/editing/search'
import type { Point } from '../document/geometry'
import classes from './ChoiceBox.module.css'
import { useModal } from './modal'

export interface Choice {
  readonly id: string
  readonly title: string
  /** In which part of the list it stands. */
  readonly group: string
  readonly detail?: string | undefined
  readonly hint?: string | undefined
  readonly icon?: ReactNode
  /** Why it cannot be chosen now. */
  readonly obstacle?: string | undefined
  readonly run: () => void
}

export interface ChoiceBoxProps {
  readonly label: string
  readonly placeholder: string
  /** What is searched here. */
  readonly choices: readonly Choice[]
  /** What is found elsewhere for the text that was typed. */
  readonly hits?: readonly Choice[]
  /** The text has changed. */
  readonly onText?: (text: string) => void
  /** Why nothing is shown. */
  readonly nothing?: string | undefined
  /** One more choice, made of what was typed. */
  readonly fromText?: ((text: string) => Choice | undefined) | undefined
  /** Where on the screen; in the upper middle without. */
  readonly at?: Point | undefined
  readonly onClose: () => void
}

const NONE: readonly Choice[] = []
const MOST = 60
const WIDTH = 420
const HEIGHT = 400

export function ChoiceBox({
  label,
  placeholder,
  choices,
  hits = NONE,
  onText,
  nothing = 'Nothing has this name',
  fromText,
  at,
  onClose,
}: ChoiceBoxProps) {
  const [text, setText] = useState('')
  const [index, setIndex] = useState(0)
  const element = useRef<HTMLDialogElement>(null)
  const list = useRef<HTMLUListElement>(null)
  const id = useId()
  const more = text.trim() ? fromText?.(text.trim()) : undefined
  const here = found(choices, text, (choice) => [choice.title, choice.group, choice.detail ?? '']).slice(0, MOST)
  const fitting = [...here, ...hits]
  // Grouped in the order in which the groups come up, best first.
  const groups = [...new Set(fitting.map((choice) => choice.group))]
  const listed = groups.flatMap((group) => fitting.filter((choice) => choice.group === group))
  // What was typed is meant as a name where it is in no title: a word of a description is not.
  const isInTitle = fitting.some((choice) => fit(text, choice.title) !== undefined)
  const shown = more ? (isInTitle ? [...listed, more] : [more, ...listed]) : listed
  const chosen = shown[Math.min(index, shown.length - 1)]

  useModal(element)
  useEffect(() => {
    list.current?.querySelector('[aria-selected="true"]')?.scrollIntoView({ block: 'nearest' })
  }, [index, text])

  function run(choice: Choice | undefined): void {
    if (!choice || choice.obstacle) return
    onClose()
    choice.run()
  }

  function onKeyDown(event: KeyboardEvent): void {
    const last = shown.length - 1
    const moves: Record<string, number> = {
      ArrowDown: index >= last ? 0 : index + 1,
      ArrowUp: index <= 0 ? last : index - 1,
      PageDown: Math.min(last, index + 8),
      PageUp: Math.max(0, index - 8),
    }
    if (event.key in moves) {
      event.preventDefault()
      setIndex(Math.max(0, moves[event.key] ?? 0))
    } else if (event.key === 'Enter') {
      event.preventDefault()
      run(chosen)
    }
    event.stopPropagation()
  }

  const style = at
    ? {
        left: Math.max(8, Math.min(at.x, innerWidth - WIDTH - 12)),
        top: Math.max(8, Math.min(at.y, innerHeight - HEIGHT - 12)),
      }
    : undefined
  return (
    // oxlint-disable-next-line jsx-a11y/click-events-have-key-events, jsx-a11y/no-noninteractive-element-interactions -- Escape closes it too
    <dialog
      ref={element}
      className={classes.box}
      data-placed={at ? true : undefined}
      style={style}
      aria-label={label}
      onClose={onClose}
      onClick={(event) => event.target === element.current && onClose()}
    >
      <div>
        <Input
          variant="unstyled"
          classNames={{ input: classes.input ?? '' }}
          role="combobox"
          aria-expanded="true"
          aria-controls={id}
          aria-activedescendant={chosen ? `${id}-${chosen.id}` : undefined}
          aria-label={label}
          placeholder={placeholder}
          autoComplete="off"
          spellCheck={false}
          value={text}
          onChange={(event) => {
            setText(event.currentTarget.value)
            onText?.(event.currentTarget.value)
            setIndex(0)
          }}
          onKeyDown={onKeyDown}
        />
        <ul
          className="plain-list"
          style={{ maxHeight: 340, padding: 5, overflowY: 'auto', cursor: 'pointer' }}
          role="listbox"
          id={id}
          aria-label={label}
          ref={list}
        >
          {shown.map((choice, position) => (
            // oxlint-disable-next-line jsx-a11y/click-events-have-key-events -- the field above has the keys of the list
            <li
              key={choice.id}
              id={`${id}-${choice.id}`}
              role="option"
              aria-selected={choice === chosen}
              aria-disabled={choice.obstacle ? true : undefined}
              title={choice.obstacle}
              onPointerMove={() => setIndex(position)}
              onClick={() => run(choice)}
            >
              {choice.group !== shown[position - 1]?.group && (
                <Text px={9} pt={7} pb={2} fz="0.74rem" fw={620} c="var(--quiet)" style={{ cursor: 'default' }}>
                  {choice.group}
                </Text>
              )}
              <span className={classes.line}>
                {choice.icon && (
                  <Text span inherit c="var(--quiet)" style={{ display: 'inline-flex', flex: 'none' }}>
                    {choice.icon}
                  </Text>
                )}
                <Text span inherit truncate fw={560} flex="none" maw="62%">
                  {choice.title}
                </Text>
                {choice.detail && (
                  <Text span truncate flex={1} miw={0} fz="0.78rem" c="var(--quiet)">
                    {choice.detail}
                  </Text>
                )}
                {choice.hint && (
                  <Kbd size="xs" ml="auto" style={{ whiteSpace: 'nowrap' }}>
                    {choice.hint}
                  </Kbd>
                )}
              </span>
            </li>
          ))}
        </ul>
        {shown.length === 0 && (
          <Text px={14} pt={10} pb={14} size="sm" c="var(--quiet)" role="status">
            {nothing}
          </Text>
        )}
      </div>
    </dialog>
  )
}
