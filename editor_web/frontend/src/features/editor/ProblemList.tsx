/** The problems of the draft, with place and advice; each leads to its node and line. */
import { IconCircleCheck } from '@tabler/icons-react'
import { Empty } from '../../components/Empty'
import { StatusIcon, statusOf } from '../../components/StatusIcon'
import { FixButtons, Words } from './FixButtons'
import { fixesOf, useFreshFixes } from './fixes'
import { goTo } from './problems'
import { draftOf, useEditor } from './store'

export function ProblemList() {
  const findings = useEditor((s) => draftOf(s).findings)
  const fixes = useFreshFixes()
  if (findings.length === 0) {
    return (
      <Empty icon={<IconCircleCheck size={26} stroke={1.4} aria-hidden />} title="No problems">
        The behavior can be run.
      </Empty>
    )
  }
  return (
    <ul className="plain-list problem-list" aria-label="Problems">
      {findings.map((finding, index) => (
        <li key={index}>
          <button type="button" className="problem" onClick={() => goTo(finding)}>
            <StatusIcon status={statusOf(finding.severity)} size={16} />
            <span className="problem-text">
              <span className="visually-hidden">{finding.severity}: </span>
              <span>
                <Words text={finding.message} />
              </span>
              {finding.hint && <span className="quiet">{finding.hint}</span>}
              <span className="quiet mono problem-place">
                {finding.path || 'document'} · line {finding.line} · {finding.code}
              </span>
            </span>
          </button>
          <FixButtons fixes={fixesOf(fixes, finding)} />
        </li>
      ))}
    </ul>
  )
}
