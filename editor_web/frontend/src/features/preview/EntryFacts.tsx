/** A named entry in words: where the arm would be, who changed it last, and its tags. */
import { DataList } from '@mantine/core'
import { traceLines } from '../../document/editing/preview'
import { wallTime } from '../../document/time'
import type { EntryTrace } from './useEntryTrace'

export function EntryFacts({ course: { row, trace } }: { readonly course: EntryTrace }) {
  const lines = trace ? traceLines(trace) : []
  return (
    <DataList size="xs" gap={2} labelWidth="8rem">
      {lines.map((line) => (
        <DataList.Item key={line.label}>
          <DataList.ItemLabel>{line.label}</DataList.ItemLabel>
          <DataList.ItemValue ff="monospace" style={{ whiteSpace: 'pre-wrap' }}>
            {line.words}
          </DataList.ItemValue>
        </DataList.Item>
      ))}
      {row && (
        <DataList.Item>
          <DataList.ItemLabel>Revision {row.revision}</DataList.ItemLabel>
          <DataList.ItemValue>
            {[row.changed_unix_ms > 0 && wallTime(row.changed_unix_ms / 1000), row.by && `by ${row.by}`, row.reason]
              .filter(Boolean)
              .join(', ')}
          </DataList.ItemValue>
        </DataList.Item>
      )}
      {row && row.tags.length > 0 && (
        <DataList.Item>
          <DataList.ItemLabel>Tags</DataList.ItemLabel>
          <DataList.ItemValue>{row.tags.join(', ')}</DataList.ItemValue>
        </DataList.Item>
      )}
    </DataList>
  )
}
