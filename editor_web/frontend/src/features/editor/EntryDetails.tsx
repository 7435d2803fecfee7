/** Below the field of a named entry: of what kind it is, what is in it, and who changed it last. */
import { useState } from 'react'
import { entryQueries } from '../../api/entries'
import { useLive } from '../../api/live'
import { useAnswer } from '../../api/queryClient'
import { entryLines } from '../../document/editing/entryText'
import { wallTime } from '../../document/time'

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
  const { value: row, problem: noRow } = useAnswer(entryQueries.row(kind, name))
  const { value: inside, problem: noValue } = useAnswer({ ...entryQueries.value(kind, name), enabled: mayCall })
  const problem = noRow ?? noValue
  if (problem) return <p className="quiet">{problem}</p>
  if (row === undefined || (mayCall && inside === undefined)) return <p className="quiet">…</p>
  if (row === null) return <p className="quiet">It is not in the store.</p>
  const lines = entryLines(kind, inside ?? {})
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
