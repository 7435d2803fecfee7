/** The sections of a failure: its causes, the way down to it, what differs from the last good run, what happened there. */
import { Anchor, List, Table, Text } from '@mantine/core'
import type { CauseLine, LogLine, MeasuredValue, RunComparison, RunFailure } from '../../api/types'
import { causeWords, differenceLines, expectedWords, measuredWords, missWords } from '../../document/failure'
import { wallTime } from '../../document/time'
import { nameOfPath } from '../../document/path'
import type { ReactNode } from 'react'
import classes from './Failure.module.css'

/** A moment of the run, at a node of it. */
export interface At {
  readonly seq: number
  readonly time_s: number
  readonly path: string
}

export function Measured({ values }: { readonly values: readonly MeasuredValue[] }) {
  return (
    <Table w="auto" verticalSpacing={3} tabularNums aria-label="Expected against measured">
      <Table.Thead>
        <Table.Tr>
          <Table.Th>Quantity</Table.Th>
          <Table.Th>Expected</Table.Th>
          <Table.Th>Measured</Table.Th>
          <Table.Th>Difference</Table.Th>
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {values.map((value) => (
          <Table.Tr key={value.quantity}>
            <Table.Td>{value.quantity}</Table.Td>
            <Table.Td>{expectedWords(value)}</Table.Td>
            <Table.Td>
              <strong>{measuredWords(value)}</strong>
            </Table.Td>
            <Table.Td c="var(--failed)">{missWords(value)}</Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </Table>
  )
}

export function Causes({ links }: { readonly links: readonly CauseLine[] }) {
  return (
    <List {...LINES}>
      {links.map((link, index) => (
        // A message may occur twice in a chain.
        // eslint-disable-next-line react/no-array-index-key
        <List.Item key={index} {...(index === 0 && ORIGIN)}>
          {index > 0 && 'so '}
          {causeWords(link)}
          <Text size="xs" c="dimmed" ff="monospace">
            {[link.kind, link.where].filter(Boolean).join(' · ')}
          </Text>
        </List.Item>
      ))}
    </List>
  )
}

interface StepsProps {
  readonly failure: RunFailure
  readonly onShow: (at: At) => void
}

export function Steps({ failure: { steps, path }, onShow }: StepsProps) {
  return (
    <List {...LINES} className={classes.steps}>
      {steps.map((step, index) => (
        <List.Item key={step.path} ml={Math.max(0, index - 1) * 14} pl={index > 0 ? 14 : 0} {...(step.path === path && ORIGIN)}>
          <Anchor {...LINK} aria-label={step.path} onClick={() => onShow(step)}>
            {nameOfPath(step.path)}
          </Anchor>{' '}
          <Text span inherit c="dimmed">
            {step.text} at {step.time_s.toFixed(2)} s
          </Text>
        </List.Item>
      ))}
    </List>
  )
}

export function LastGood({ comparison }: { readonly comparison: RunComparison | null | undefined }) {
  if (comparison === undefined) return <Quiet>Reading…</Quiet>
  if (comparison === null) return <Quiet>No earlier run of this behavior in the journal succeeded.</Quiet>
  const lines = differenceLines(comparison)
  return (
    <>
      <Quiet>The last good run started {wallTime(comparison.left.started_at_s)}.</Quiet>
      <List {...LINES}>
        {comparison.divergence && <List.Item {...ORIGIN}>{comparison.divergence.text}</List.Item>}
        {lines.map((line) => (
          <List.Item key={line}>{line}</List.Item>
        ))}
        {!comparison.divergence && lines.length === 0 && <List.Item>Nothing differs.</List.Item>}
      </List>
    </>
  )
}

export function Around({ lines, onShow }: { readonly lines: readonly LogLine[]; readonly onShow: (at: At) => void }) {
  return (
    <List {...LINES}>
      {lines.map((line) => (
        <List.Item key={line.seq}>
          <Anchor {...LINK} aria-label={`${line.time_s.toFixed(2)} s: ${line.text}`} onClick={() => onShow(line)}>
            {line.time_s.toFixed(2)} s
          </Anchor>{' '}
          {line.text}
        </List.Item>
      ))}
    </List>
  )
}

function Quiet({ children }: { readonly children: ReactNode }) {
  return (
    <Text size="sm" c="dimmed">
      {children}
    </Text>
  )
}

const LINES = { type: 'ordered', listStyleType: 'none', size: 'sm', spacing: 4 } as const
const ORIGIN = { c: 'var(--failed)', fw: 620 } as const
const LINK = { component: 'button', type: 'button', inherit: true, c: 'inherit', underline: 'always' } as const
