/** What is left of a failing run, one factor a row, and saving it as a test case. */
import { Anchor, Button, Code, Group, Table, TextInput } from '@mantine/core'
import { useState } from 'react'
import type { Shrunk } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { chanceText, proposedCase, shrunkRows } from '../../document/searches'
import { Chain, Note } from './Note'
import { ResultTable } from './ResultTable'

export interface ShrunkChangeProps {
  readonly sweep: string
  readonly number: number
  readonly found: Shrunk
  /** The file of the test case; empty before it is saved. */
  readonly savedAs: string
  /** Undefined for those who only view. */
  readonly onSave: ((file: string) => Promise<void>) | undefined
  readonly onOpenSweep: (id: string) => void
}

export function ShrunkChange({ sweep, number, found, savedAs, onSave, onOpenSweep }: ShrunkChangeProps) {
  const rows = shrunkRows(found)
  return (
    <>
      {rows.length > 0 && (
        <ResultTable label="The smallest change from nominal">
          <Table.Thead>
            <Table.Tr>
              <Table.Th scope="col">Factor</Table.Th>
              <Table.Th scope="col" ta="right">
                Nominal
              </Table.Th>
              <Table.Th scope="col" ta="right">
                Fails with
              </Table.Th>
              <Table.Th scope="col" ta="right">
                Does not fail so with
              </Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {rows.map((row) => (
              <Table.Tr key={row.address}>
                <Table.Th scope="row" ff="monospace">
                  {row.address}
                </Table.Th>
                <Table.Td ta="right">{row.nominal}</Table.Td>
                <Table.Td ta="right">
                  <strong>{row.failing}</strong>
                </Table.Td>
                <Table.Td ta="right">{row.passing || '–'}</Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </ResultTable>
      )}
      <Note>{chanceText(found)}</Note>
      {found.result.cause && <Chain cause={found.result.cause} />}
      <Note isQuiet>
        {found.interrupted ? `Stopped after ${found.runs} runs: a smaller change may fail too.` : `Found in ${found.runs} runs.`}
      </Note>
      {savedAs ? (
        <Saved file={savedAs} onOpenSweep={onOpenSweep} />
      ) : (
        onSave && <SaveCase proposed={proposedCase(sweep, number)} onSave={onSave} />
      )}
    </>
  )
}

function SaveCase({ proposed, onSave }: { readonly proposed: string; readonly onSave: (file: string) => Promise<void> }) {
  const [file, setFile] = useState(proposed)
  const [isSaving, setSaving] = useState(false)

  async function save(): Promise<void> {
    setSaving(true)
    await onSave(file)
    setSaving(false)
  }

  return (
    <form
      onSubmit={(event) => {
        event.preventDefault()
        if (!isSaving) void save()
      }}
    >
      <Group gap="xs" my="3xs">
        <Button size="xs" type="submit" aria-disabled={isSaving || undefined} data-disabled={isSaving}>
          {isSaving ? 'Saving …' : 'Save as a test case'}
        </Button>
        <TextInput
          size="xs"
          flex="0 1 24rem"
          aria-label="File of the test case"
          value={file}
          onChange={(event) => setFile(event.currentTarget.value)}
        />
      </Group>
    </form>
  )
}

function Saved({ file, onOpenSweep }: { readonly file: string; readonly onOpenSweep: (id: string) => void }) {
  return (
    <Group gap="3xs" wrap="nowrap" fz="0.82rem" role="status">
      <StatusIcon status="done" size={14} />
      <span>
        Saved as{' '}
        <Anchor c="var(--accent)" component="button" inherit type="button" onClick={() => onOpenSweep(file)}>
          {file}
        </Anchor>
        , which fails until it is mended. pytest collects the folders in <Code>flexcell_sweeps</Code>.
      </span>
    </Group>
  )
}
