/** What the check says of each node and arrow, to be shown there. */
import { useMemo } from 'react'
import type { FindingView } from '../../api/types'
import { isError, problemsOf } from '../../document/editing/findings'
import { pathsTo } from '../../document/path'
import { draftOf, useEditor } from './store'

export interface Mark {
  readonly severity: 'error' | 'warning'
  readonly messages: readonly string[]
}

const NONE: readonly FindingView[] = []

/** The findings at a node; with `inside`, also those of the nodes in it. */
export function useMark(path: string, inside: boolean): Mark | undefined {
  const own = useEditor((s) => {
    const { at, around } = placedOf(problemsOf(draftOf(s)))
    return (inside ? around : at).get(path)
  })
  return useMemo(() => {
    if (!own) return undefined
    const severity = own.some(isError) ? 'error' : 'warning'
    return { severity, messages: own.map((finding) => finding.message) }
  }, [own])
}

/** The fields of a node that the file has changed too; with `inside`, also those of the nodes in it. */
export function useConflicts(path: string, inside: boolean): number {
  return useEditor((s) => {
    const conflicts = s.conflict?.merge?.conflicts
    if (!conflicts) return 0
    return conflicts.filter((each) => each.path === path || (inside && pathsTo(each.path).includes(path))).length
  })
}

interface Placed {
  readonly at: ReadonlyMap<string, readonly FindingView[]>
  /** Those at a node and at the nodes in it. */
  readonly around: ReadonlyMap<string, readonly FindingView[]>
}

const placed = new WeakMap<readonly FindingView[], Placed>()

/** The findings by node: a thousand nodes ask for theirs each time something changes. */
function placedOf(findings: readonly FindingView[]): Placed {
  const known = placed.get(findings)
  if (known) return known
  const at = new Map<string, FindingView[]>()
  const around = new Map<string, FindingView[]>()
  const put = (into: Map<string, FindingView[]>, path: string, finding: FindingView) =>
    into.get(path)?.push(finding) ?? into.set(path, [finding])
  for (const finding of findings) {
    put(at, finding.path, finding)
    for (const path of pathsTo(finding.path)) put(around, path, finding)
  }
  placed.set(findings, { at, around })
  return { at, around }
}

/** The findings that name an outcome: they are shown at its arrow or port. */
function findingsOfTransition(findings: readonly FindingView[], path: string, outcome: string): readonly FindingView[] {
  return findings.filter((finding) => finding.path === path && finding.message.includes(`\`${outcome}\``))
}

export function useTransitionFindings(path: string, outcome: string): readonly FindingView[] {
  const findings = useEditor((s) => placedOf(problemsOf(draftOf(s))).at.get(path))
  return useMemo(() => {
    const own = findings ? findingsOfTransition(findings, path, outcome) : NONE
    return own.length > 0 ? own : NONE
  }, [findings, path, outcome])
}

/** The container to show for a finding's node: the nearest one that exists around it. */
export function nearestPath(paths: ReadonlySet<string>, path: string): string | undefined {
  return pathsTo(path)
    .toReversed()
    .find((each) => paths.has(each))
}
