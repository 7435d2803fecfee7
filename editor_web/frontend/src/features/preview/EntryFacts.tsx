/** A named entry in words: where the arm would be, who changed it last, and its tags. */
import { traceLines } from '../../document/editing/preview'
import { wallTime } from '../../document/time'
import type { EntryTrace } from './useEntryTrace'

export function EntryFacts({ course: { row, trace } }: { readonly course: EntryTrace }) {
  const lines = trace ? traceLines(trace) : []
  return (
    <dl className="preview-facts">
      {lines.map((line) => (
        <div key={line.label}>
          <dt>{line.label}</dt>
          <dd className="mono">{line.words}</dd>
        </div>
      ))}
      {row && (
        <div>
          <dt>Revision {row.revision}</dt>
          <dd>
            {[row.changed_unix_ms > 0 && wallTime(row.changed_unix_ms / 1000), row.by && `by ${row.by}`, row.reason]
              .filter(Boolean)
              .join(', ')}
          </dd>
        </div>
      )}
      {row && row.tags.length > 0 && (
        <div>
          <dt>Tags</dt>
          <dd>{row.tags.join(', ')}</dd>
        </div>
      )}
    </dl>
  )
}
