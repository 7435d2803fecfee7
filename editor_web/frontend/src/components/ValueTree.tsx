/** Any JSON value as a tree to unfold; short values stand on one line. */
import { Text, UnstyledButton } from '@mantine/core'
import { IconChevronDown, IconChevronRight } from '@tabler/icons-react'
import { memo, useState } from 'react'
import { inShort, isShort } from '../document/values'
import classes from './ValueTree.module.css'

interface ValueTreeProps {
  readonly label: string
  readonly value: unknown
  /** Levels that are unfolded at first. */
  readonly open?: number
}

export const ValueTree = memo(function ValueTree({ label, value, open = 1 }: ValueTreeProps) {
  return (
    <ul className={`${classes.tree} plain-list`} aria-label={label}>
      {isShort(value) ? (
        <li className={classes.line}>
          <Short value={value} />
        </li>
      ) : (
        <Parts value={value} open={open} />
      )}
    </ul>
  )
})

function Parts({ value, open }: { value: unknown; open: number }) {
  const parts = Array.isArray(value) ? value.map((each, index) => [String(index), each] as const) : Object.entries(value as object)
  return parts.map(([name, part]) => <Part key={name} name={name} value={part as unknown} open={open} />)
}

function Part({ name, value, open }: { name: string; value: unknown; open: number }) {
  const [isOpen, setOpen] = useState(open > 0)
  if (isShort(value)) {
    return (
      <li className={classes.line}>
        <Name>{name}</Name>
        <Short value={value} />
      </li>
    )
  }
  const Chevron = isOpen ? IconChevronDown : IconChevronRight
  return (
    <li>
      <UnstyledButton className={`${classes.line} pick-row`} aria-expanded={isOpen} onClick={() => setOpen(!isOpen)}>
        <Chevron size={12} aria-hidden />
        <Name>{name}</Name>
        {!isOpen && (
          <Text span inherit c="var(--quiet)">
            {inShort(value)}
          </Text>
        )}
      </UnstyledButton>
      {isOpen && (
        <ul className="plain-list" aria-label={name}>
          <Parts value={value} open={open - 1} />
        </ul>
      )}
    </li>
  )
}

function Short({ value }: { value: unknown }) {
  return (
    <span className={classes.value} data-type={value === null ? 'null' : typeof value}>
      {inShort(value)}
    </span>
  )
}

function Name({ children }: { readonly children: string }) {
  return (
    <Text span inherit flex="none" c="var(--quiet)">
      {children}
    </Text>
  )
}
