/** What would fix a problem, each to be chosen; and the problems of one node in its form. */
import { IconBulb } from '@tabler/icons-react'
import type { Fix } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { problemsOf } from '../../document/editing/findings'
import { statusOf } from '../../document/runState'
import { makeFix } from './fixes'
import { goTo } from './problems'
import { draftOf, useEditor } from './store'

export function FixButtons({ fixes }: { fixes: readonly Fix[] }) {
  if (fixes.length === 0) return null
  return (
    <div className="fixes" role="group" aria-label="Fixes">
      {fixes.map((fix) => (
        <button key={fix.title} type="button" className="fix" onClick={() => makeFix(fix)}>
          <IconBulb size={13} aria-hidden />
          <span>
            <Words text={fix.title} />
          </span>
        </button>
      ))}
    </div>
  )
}

/** Names in backticks are set as code. */
export function Words({ text }: { text: string }) {
  return text.split('`').map((part, index) => (index % 2 === 1 ? <code key={index}>{part}</code> : part))
}

/** Over the form of a node: a line each, which leads to the list of problems with its fixes. */
export function NodeFindings({ path }: { path: string }) {
  const findings = useEditor((s) => problemsOf(draftOf(s)))
  const own = findings.filter((finding) => finding.path === path)
  if (own.length === 0) return null
  return (
    <ul className="plain-list node-findings" aria-label="Problems of this node">
      {own.map((finding, index) => (
        <li key={index}>
          <button type="button" className="problem" title={`${finding.message}. Show it with its fixes`} onClick={() => goTo(finding)}>
            <StatusIcon status={statusOf(finding.severity)} size={15} />
            <span className="problem-line">
              <span className="visually-hidden">{finding.severity}: </span>
              <Words text={finding.message} />
            </span>
          </button>
        </li>
      ))}
    </ul>
  )
}
