/** The problems of a document, with place and advice. */
import { IconCircleCheck } from '@tabler/icons-react'
import type { FindingView } from '../../api/types'
import { Empty } from '../../components/Empty'
import { StatusIcon } from '../../components/StatusIcon'
import { statusOf } from '../../document/runState'
import { nameOfPath } from '../../document/path'

export interface FindingListProps {
  readonly document: string
  readonly findings: readonly FindingView[]
  readonly onSelect: (path: string) => void
}

export function FindingList({ document, findings, onSelect }: FindingListProps) {
  if (findings.length === 0) {
    return (
      <Empty icon={<IconCircleCheck size={26} stroke={1.4} aria-hidden />} title="No problems">
        The document can be run.
      </Empty>
    )
  }
  return (
    <ul className="plain-list findings">
      {findings.map((finding, index) => (
        <li key={index} className="finding">
          <StatusIcon status={statusOf(finding.severity)} size={16} />
          <div>
            <div>
              <span className="visually-hidden">{finding.severity}: </span>
              {finding.message}
            </div>
            {finding.hint && <div className="quiet">{finding.hint}</div>}
            <div className="quiet mono finding-place">
              {nameOfPath(document)}:{finding.line}:{finding.column} · {finding.code}
              {finding.path && (
                <button type="button" className="link" onClick={() => onSelect(finding.path)}>
                  {finding.path}
                </button>
              )}
            </div>
          </div>
        </li>
      ))}
    </ul>
  )
}
