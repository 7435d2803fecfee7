/** The problems of the draft, with place and advice; each leads to its node and line. */
import { IconCircleCheck } from '@tabler/icons-react'
import { Empty } from '../../components/Empty'
import { StatusIcon, statusOf } from '../../components/StatusIcon'
import { problemsOf } from '../../document/editing/findings'
import { FixButtons, Words } from './FixButtons'
import { fixesOf, useFreshFixes } from './fixes'
import { goTo } from './problems'
import { draftOf, useEditor } from './store'
import { setTargetLevel, useTargets, type TargetLevel } from './targets'

export function ProblemList() {
  return (
    <>
      <Problems />
      <TargetChoice />
    </>
  )
}

/** What targets count as that an arm cannot be at, and why they are not known. */
function TargetChoice() {
  const { level, problem } = useTargets()
  return (
    <div className="target-choice">
      <label>
        <span>Targets out of reach or in collision</span>
        <select
          className="plain-input"
          value={level}
          onChange={(event) => setTargetLevel(event.currentTarget.value as TargetLevel)}
        >
          <option value="warning">are warnings</option>
          <option value="error">are errors</option>
          <option value="off">are not looked for</option>
        </select>
      </label>
      {problem && <p className="quiet">{problem}</p>}
    </div>
  )
}

function Problems() {
  const findings = useEditor((s) => problemsOf(draftOf(s)))
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
