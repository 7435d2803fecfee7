/** What the check says of each node and arrow, to be shown there. */
import { useMemo } from 'react'
import type { FindingBody } from '../../api/types'
import { pathsTo } from '../../document/editing/model'
import { draftOf, useEditor } from './store'

export interface Mark {
  readonly severity: 'error' | 'warning'
  readonly messages: readonly string[]
}

const NONE: readonly FindingBody[] = []

/** The findings at a node; with `inside`, also those of the nodes in it. */
export function useMark(path: string, inside: boolean): Mark | undefined {
  const findings = useEditor((s) => draftOf(s).findings)
  return useMemo(() => {
    const own = findings.filter((finding) => finding.path === path || (inside && finding.path.startsWith(`${path}/`)))
    if (own.length === 0) return undefined
    const severity = own.some((finding) => finding.severity === 'error') ? 'error' : 'warning'
    return { severity, messages: own.map((finding) => finding.message) }
  }, [findings, path, inside])
}

/** The findings that name a way out: they are shown at its arrow or port. */
export function findingsOfWay(findings: readonly FindingBody[], path: string, outcome: string): readonly FindingBody[] {
  return findings.filter((finding) => finding.path === path && finding.message.includes(`\`${outcome}\``))
}

export function useWayFindings(path: string, outcome: string): readonly FindingBody[] {
  const findings = useEditor((s) => draftOf(s).findings)
  return useMemo(() => {
    const own = findingsOfWay(findings, path, outcome)
    return own.length > 0 ? own : NONE
  }, [findings, path, outcome])
}

/** The container to show for a finding's node: the nearest one that exists around it. */
export function nearestPath(paths: ReadonlySet<string>, path: string): string | undefined {
  return [...pathsTo(path)].reverse().find((each) => paths.has(each))
}
