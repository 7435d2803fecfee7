/** The problems of a text: what the check finds, and the targets that an arm cannot be at, in the order of the text. Pure. */
import type { FindingView } from '../../api/types'
import { allNodes, isHolder, type Draft, type EditNode } from './model'

type Findings = readonly FindingView[]

interface Known {
  readonly targets: Findings
  readonly root: EditNode | undefined
  readonly all: Findings
}

const together = new WeakMap<Findings, Known>()

/**
 * All problems of a draft but those of empty containers, which are being built; the same list as long as its parts are the same.
 */
export function problemsOf({ findings, targets, root }: Pick<Draft, 'findings' | 'targets' | 'root'>): Findings {
  const known = together.get(findings)
  if (known?.targets === targets && known.root === root) return known.all
  const empty = emptyContainers(root)
  const due = empty.size === 0 ? findings : findings.filter((finding) => finding.code !== 'invalid-document' || !empty.has(finding.path))
  const all = targets.length === 0 ? due : [...due, ...targets].toSorted((a, b) => a.line - b.line || a.column - b.column)
  together.set(findings, { targets, root, all })
  return all
}

const NONE: ReadonlySet<string> = new Set()
const emptyOf = new WeakMap<EditNode, ReadonlySet<string>>()

/** The paths of containers without anything in them: a document that has one is not finished, and no mistake was made. */
export function emptyContainers(root: EditNode | undefined): ReadonlySet<string> {
  if (!root) return NONE
  const known = emptyOf.get(root)
  if (known) return known
  const empty = allNodes(root).filter((node) => isHolder(node) && node.children.length === 0)
  const paths = new Set(empty.map((node) => node.path))
  emptyOf.set(root, paths)
  return paths
}

/** What is left to do in a document that is not finished; empty for a finished one. */
export function unfinishedWords(root: EditNode | undefined): string {
  const empty = emptyContainers(root).size
  if (empty === 0) return ''
  return empty === 1 ? 'A container is empty: add a node to it.' : `${empty} containers are empty: add a node to each.`
}

/** Those of before where they say the same, so that nothing is drawn again for them. */
export function sameFindings(before: Findings | undefined, findings: Findings): Findings {
  return before && JSON.stringify(before) === JSON.stringify(findings) ? before : findings
}

/** Whether a finding keeps a document from being run. */
export function isError({ severity }: FindingView): boolean {
  return severity === 'error'
}
