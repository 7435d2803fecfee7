/** What is left of a failing run, one factor a row, and saving it as a test case. */
import { useState } from 'react'
import type { Shrunk } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { chanceText, proposedCase, shrunkRows } from '../../document/searches'

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
        <div className="sweep-scroll" tabIndex={0} role="group" aria-label="The smallest change from nominal">
          <table className="sweep-table">
            <thead>
              <tr>
                <th scope="col">Factor</th>
                <th scope="col" className="is-number">
                  Nominal
                </th>
                <th scope="col" className="is-number">
                  Fails with
                </th>
                <th scope="col" className="is-number">
                  Does not fail so with
                </th>
              </tr>
            </thead>
            <tbody>
              {rows.map((row) => (
                <tr key={row.address}>
                  <th scope="row" className="mono">
                    {row.address}
                  </th>
                  <td className="is-number">{row.nominal}</td>
                  <td className="is-number">
                    <strong>{row.failing}</strong>
                  </td>
                  <td className="is-number">{row.passing || '–'}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
      <p className="sweep-note">{chanceText(found)}</p>
      {found.result.cause && <p className="sweep-chain">{found.result.cause}</p>}
      <p className="quiet sweep-note">
        {found.interrupted ? `Stopped after ${found.runs} runs: a smaller change may fail too.` : `Found in ${found.runs} runs.`}
      </p>
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
      className="sweep-shrink-start"
      onSubmit={(event) => {
        event.preventDefault()
        if (!isSaving) void save()
      }}
    >
      <button type="submit" className="command is-strong" aria-disabled={isSaving || undefined}>
        {isSaving ? 'Saving …' : 'Save as a test case'}
      </button>
      <input
        className="new-input mono sweep-shrink-file"
        aria-label="File of the test case"
        value={file}
        onChange={(event) => setFile(event.currentTarget.value)}
      />
    </form>
  )
}

function Saved({ file, onOpenSweep }: { readonly file: string; readonly onOpenSweep: (id: string) => void }) {
  return (
    <p className="sweep-note sweep-outcome" role="status">
      <StatusIcon status="done" size={14} />
      <span>
        Saved as{' '}
        <button type="button" className="link" onClick={() => onOpenSweep(file)}>
          {file}
        </button>
        , which fails until it is mended. pytest collects the folders in <code className="sweep-command">flexcell_sweeps</code>.
      </span>
    </p>
  )
}
