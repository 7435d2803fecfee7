/** The problems of a text: what the check finds, and the targets that an arm cannot be at, in the order of the text. Pure. */
import type { FindingView } from '../../api/types'
import type { Draft } from './model'

type Findings = readonly FindingView[]

const together = new WeakMap<Findings, { readonly targets: Findings; readonly all: Findings }>()

/** All problems of a draft; the same list as long as both parts are the same. */
export function problemsOf({ findings, targets }: Pick<Draft, 'findings' | 'targets'>): Findings {
  if (targets.length === 0) return findings
  const known = together.get(findings)
  if (known?.targets === targets) return known.all
  const all = [...findings, ...targets].toSorted((a, b) => a.line - b.line || a.column - b.column)
  together.set(findings, { targets, all })
  return all
}

/** Those of before where they say the same, so that nothing is drawn again for them. */
export function sameFindings(before: Findings | undefined, findings: Findings): Findings {
  return before && JSON.stringify(before) === JSON.stringify(findings) ? before : findings
}
