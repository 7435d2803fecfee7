/** The problems of the draft, with place and advice; each leads to its node and line. */
import { IconCircleCheck, IconCircleDashed } from '@tabler/icons-react'
import type { FindingView, Fix } from '../../api/types'
import { Empty } from '../../components/Empty'
import { StatusIcon } from '../../components/StatusIcon'
import { emptyContainers, problemsOf } from '../../document/editing/findings'
import { statusOf } from '../../document/runState'
import { FixButtons, Words } from './FixButtons'
import { fixesOf, useFreshFixes } from './fixes'
import { goTo } from './problems'
import { draftOf, setEditor, useEditor } from './store'
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
        <select className="plain-input" value={level} onChange={(event) => setTargetLevel(event.currentTarget.value as TargetLevel)}>
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
  const empty = useEditor((s) => emptyContainers(draftOf(s).root).size)
  const fixes = useFreshFixes()
  if (findings.length === 0) {
    return empty > 0 ? (
      <Empty icon={<IconCircleDashed size={26} stroke={1.4} aria-hidden />} title="Not finished">
        {empty === 1 ? 'A container is empty: add a node to it.' : `${empty} containers are empty: add a node to each.`}
      </Empty>
    ) : (
      <Empty icon={<IconCircleCheck size={26} stroke={1.4} aria-hidden />} title="No problems">
        The behavior can be run.
      </Empty>
    )
  }
  return (
    <ul className="plain-list problem-list" aria-label="Problems">
      {findings.map((finding) => (
        <Problem key={keyOf(finding)} finding={finding} fixes={fixesOf(fixes, finding)} />
      ))}
    </ul>
  )
}

function keyOf({ line, column, code, path, message }: FindingView): string {
  return [line, column, code, path, message].join(' ')
}

/** One line, which leads to its node and unfolds advice, place and fixes. */
function Problem({ finding, fixes }: { readonly finding: FindingView; readonly fixes: readonly Fix[] }) {
  const place = useEditor((s) => s.place)
  const isOpen = place?.line === finding.line && place.column === finding.column
  return (
    <li>
      <button
        type="button"
        className="problem"
        aria-expanded={isOpen}
        onClick={() => (isOpen ? setEditor({ place: undefined }) : goTo(finding))}
      >
        <StatusIcon status={statusOf(finding.severity)} size={16} />
        <span className="problem-line">
          <span className="visually-hidden">{finding.severity}: </span>
          <Words text={finding.message} />
        </span>
        <span className="quiet problem-place">line {finding.line}</span>
      </button>
      {isOpen && (
        <div className="problem-more">
          {finding.hint && <p className="quiet">{finding.hint}</p>}
          <p className="quiet mono problem-place">
            {finding.path || 'document'} · {finding.code}
          </p>
          <FixButtons fixes={fixes} />
        </div>
      )}
    </li>
  )
}
