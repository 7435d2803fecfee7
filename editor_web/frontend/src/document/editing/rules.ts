/** The rules of a concurrency container: changed as a table, written as conditions. Pure. */
import { without as withoutName, type Dict } from '../dict'
import type { EditNode } from './model'

export interface Rule {
  readonly outcome: string
  readonly when: Dict<string>
}

/** As documents write them: `[{finished: {left: reached}}]`. */
export function conditionsOf(
  rules: readonly Rule[],
): readonly Dict<Dict<string>>[] {
  return rules.map(({ outcome, when }) => ({ [outcome]: when }))
}

export function renamedOutcome(rules: readonly Rule[], index: number, outcome: string): readonly Rule[] {
  return rules.map((rule, at) => (at === index ? { ...rule, outcome } : rule))
}

/** Ask for an outcome of a child in one rule; empty asks for none. A rule asks for one child at least. */
export function withChild(rules: readonly Rule[], index: number, child: string, outcome: string): readonly Rule[] {
  return rules.map((rule, at) => {
    if (at !== index) return rule
    const when = outcome === '' ? withoutName(rule.when, child) : { ...rule.when, [child]: outcome }
    return Object.keys(when).length === 0 ? rule : { ...rule, when }
  })
}

export function moved(rules: readonly Rule[], index: number, by: number): readonly Rule[] {
  const next = [...rules]
  next.splice(index + by, 0, ...next.splice(index, 1))
  return next
}

export function without(rules: readonly Rule[], index: number): readonly Rule[] {
  return rules.filter((_, at) => at !== index)
}

/** One more rule, of what is not said yet: first that all have done well, then for each child that it has not. */
export function added(
  rules: readonly Rule[],
  children: readonly Pick<EditNode, 'name' | 'outcomes'>[],
): readonly Rule[] {
  const all = Object.fromEntries(
    children.flatMap((child) => (child.outcomes[0] ? [[child.name, child.outcomes[0]]] : [])),
  )
  const candidates: Rule[] = [
    { outcome: 'finished', when: all },
    ...children.flatMap((child) =>
      child.outcomes.slice(1).map((outcome) => ({ outcome: 'failed', when: { [child.name]: outcome } })),
    ),
  ]
  const said = new Set(rules.map((rule) => textOf(rule.when)))
  const next = candidates.find((rule) => Object.keys(rule.when).length > 0 && !said.has(textOf(rule.when)))
  return next ? [...rules, next] : [...rules, { outcome: 'finished', when: all }]
}

function textOf(when: Rule['when']): string {
  return Object.entries(when)
    .map(([child, outcome]) => `${child}=${outcome}`)
    .sort()
    .join()
}
