/** Below the field of a named entry: of what kind it is, what is in it, and who changed it last. */
import { useEffect, useState } from 'react'
import { entries } from '../../api/entries'
import { wordsOf } from '../../api/client'
import { useLive } from '../../api/live'
import type { EntryChanged } from '../../api/types'
import { entryLines, type EntryLine } from '../../document/editing/entryText'
import { wallTime } from '../../document/time'

interface Details {
  readonly of: string
  readonly row: EntryChanged | undefined
  readonly lines: readonly EntryLine[]
}

export function EntryDetails({ kind, name }: { kind: string; name: string }) {
  const [isOpen, setOpen] = useState(false)
  return (
    <details className="entry-details" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>
        About {name} <span className="quiet">{kind}</span>
      </summary>
      {isOpen && <Inside kind={kind} name={name} />}
    </details>
  )
}

/** Fetched only when somebody looks. */
function Inside({ kind, name }: { kind: string; name: string }) {
  const mayCall = useLive((s) => s.role === 'operator')
  const [known, setKnown] = useState<Details>()
  const [problem, setProblem] = useState('')
  const of = `${kind} ${name}`
  useEffect(() => {
    let isCurrent = true
    const value = mayCall ? entries.value(kind, name) : Promise.resolve({})
    Promise.all([entries.row(kind, name), value]).then(
      ([row, inside]) => isCurrent && setKnown({ of: `${kind} ${name}`, row, lines: entryLines(kind, inside) }),
      (error: unknown) => isCurrent && setProblem(wordsOf(error)),
    )
    return () => {
      isCurrent = false
    }
  }, [kind, name, mayCall])
  if (problem) return <p className="quiet">{problem}</p>
  if (known?.of !== of || !known.row) return <p className="quiet">{known?.of === of ? 'It is not in the store.' : '…'}</p>
  const { row, lines } = known
  const changed = [`revision ${row.revision}`, row.changed_unix_ms > 0 && wallTime(row.changed_unix_ms / 1000), row.by && `by ${row.by}`]
  return (
    <>
      <p className="quiet">{changed.filter(Boolean).join(', ')}</p>
      {row.tags.length > 0 && <p className="quiet">{row.tags.join(', ')}</p>}
      {row.reason && <p className="quiet">{row.reason}</p>}
      <dl>
        {lines.map((line) => (
          <div key={line.label}>
            <dt>{line.label}</dt>
            <dd className="mono">{line.words}</dd>
          </div>
        ))}
      </dl>
    </>
  )
}
