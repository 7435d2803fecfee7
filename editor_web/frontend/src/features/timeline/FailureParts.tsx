/** The sections of a failure: its causes, the way down to it, what differs from the last good run, what happened there. */
import { Table } from '@mantine/core'
import type { CauseLink, LogLine, MeasuredValue, RunComparison, RunFailure } from '../../api/types'
import { differenceLines, expectedWords, measuredWords, missWords } from '../../document/failure'
import { wallTime } from '../../document/time'
import { nameOfPath } from '../../document/path'
import classes from './Failure.module.css'

/** A moment of the run, at a node of it. */
export interface At {
  readonly seq: number
  readonly time_s: number
  readonly path: string
}

export function Measured({ values }: { readonly values: readonly MeasuredValue[] }) {
  if (values.length === 0) return null
  return (
    <Table className={classes.measured} verticalSpacing={3} aria-label="Expected against measured">
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
            <Table.Td className={classes.miss}>{missWords(value)}</Table.Td>
          </Table.Tr>
        ))}
      </Table.Tbody>
    </Table>
  )
}

export function Causes({ links }: { readonly links: readonly CauseLink[] }) {
  return (
    <ol>
      {links.map((link, index) => (
        // A message may occur twice in a chain.
        // eslint-disable-next-line react/no-array-index-key
        <li key={index} className={index === 0 ? 'is-origin' : undefined}>
          {index > 0 && <span className="quiet">so </span>}
          {link.message}
          <div className="quiet mono">{[link.kind, link.where].filter(Boolean).join(' · ')}</div>
        </li>
      ))}
    </ol>
  )
}

interface StepsProps {
  readonly failure: RunFailure
  readonly onShow: (at: At) => void
}

export function Steps({ failure: { steps, path }, onShow }: StepsProps) {
  return (
    <ol className="failure-steps">
      {steps.map((step, index) => (
        <li
          key={step.path}
          className={step.path === path ? 'is-origin' : undefined}
          style={{ marginInlineStart: Math.max(0, index - 1) * 14 }}
        >
          <button type="button" className="link-row" onClick={() => onShow(step)}>
            {nameOfPath(step.path)}
          </button>{' '}
          <span className="quiet">
            {step.text} at {step.time_s.toFixed(2)} s
          </span>
        </li>
      ))}
    </ol>
  )
}

export function LastGood({ comparison }: { readonly comparison: RunComparison | null | undefined }) {
  if (comparison === undefined) return <p className="quiet">Reading…</p>
  if (comparison === null) return <p className="quiet">No earlier run of this behavior in the journal succeeded.</p>
  const lines = differenceLines(comparison)
  return (
    <>
      <p className="quiet">The last good run started {wallTime(comparison.left.started_at_s)}.</p>
      <ol>
        {comparison.divergence && <li className="is-origin">{comparison.divergence.text}</li>}
        {lines.map((line) => (
          <li key={line}>{line}</li>
        ))}
        {!comparison.divergence && lines.length === 0 && <li>Nothing differs.</li>}
      </ol>
    </>
  )
}

export function Around({ lines, onShow }: { readonly lines: readonly LogLine[]; readonly onShow: (at: At) => void }) {
  return (
    <ol>
      {lines.map((line) => (
        <li key={line.seq}>
          <button type="button" className="link-row" onClick={() => onShow(line)}>
            {line.time_s.toFixed(2)} s
          </button>{' '}
          {line.text}
        </li>
      ))}
    </ol>
  )
}
