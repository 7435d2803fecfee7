/** The rules of a concurrency container: changed as a table, written as conditions. Pure. */
import { without as withoutName, type Dict } from '../dict'
import type { ConcurrencyCondition } from '../../api/types'
import type { EditNode } from './model'

export type Condition = Dict<Dict<string | number> | readonly string[]>

/**
 * As documents write them: `[{finished: {left: reached, right: reached, at_least: 1}}]`, or
 * `[{preempt: [right], when: {left: failed}}]`.
 */
export function conditionsOf(rules: readonly ConcurrencyCondition[]): readonly Condition[] {
  return rules.map(({ outcome, when, at_least, preempt }) => {
    const asked = at_least === null ? when : { ...when, at_least }
    return preempt.length > 0 ? { preempt, when: asked } : { [outcome]: asked }
  })
}

/** What comes of a rule, in words: its outcome, or whom it preempts. */
export function consequenceOf({ outcome, preempt }: Pick<ConcurrencyCondition, 'outcome' | 'preempt'>): string {
  return preempt.length > 0 ? `preempt ${preempt.join(', ')}` : outcome
}

/** Have a rule preempt a child or not. With its first one it decides no outcome any more, with its last one it does. */
export function withPreempted(
  rules: readonly ConcurrencyCondition[],
  index: number,
  child: string,
  isPreempted: boolean,
): readonly ConcurrencyCondition[] {
  return rules.map((rule, at) => {
    if (at !== index) return rule
    const others = rule.preempt.filter((name) => name !== child)
    const preempt = isPreempted ? [...others, child] : others
    if (preempt.length > 0) return { ...rule, outcome: '', preempt }
    return { ...rule, outcome: rule.outcome || 'failed', preempt }
  })
}

/** Ask for so many of the children that a rule names; all of them, and more than all, is said without a number. */
export function withCount(rules: readonly ConcurrencyCondition[], index: number, count: number): readonly ConcurrencyCondition[] {
  return rules.map((rule, at) => (at === index ? counted(rule, count) : rule))
}

function counted(rule: ConcurrencyCondition, count: number | null): ConcurrencyCondition {
  const all = count === null || count >= Object.keys(rule.when).length
  return { ...rule, at_least: all ? null : count }
}

export function renamedOutcome(rules: readonly ConcurrencyCondition[], index: number, outcome: string): readonly ConcurrencyCondition[] {
  return rules.map((rule, at) => (at === index ? { ...rule, outcome } : rule))
}

/** Ask for an outcome of a child in one rule; empty asks for none. A rule asks for one child at least. */
export function withChild(
  rules: readonly ConcurrencyCondition[],
  index: number,
  child: string,
  outcome: string,
): readonly ConcurrencyCondition[] {
  return rules.map((rule, at) => {
    if (at !== index) return rule
    const when = outcome === '' ? withoutName(rule.when, child) : { ...rule.when, [child]: outcome }
    return Object.keys(when).length === 0 ? rule : counted({ ...rule, when }, rule.at_least)
  })
}

export function moved(rules: readonly ConcurrencyCondition[], index: number, by: number): readonly ConcurrencyCondition[] {
  const next = [...rules]
  next.splice(index + by, 0, ...next.splice(index, 1))
  return next
}

export function without(rules: readonly ConcurrencyCondition[], index: number): readonly ConcurrencyCondition[] {
  return rules.filter((_, at) => at !== index)
}

/** One more rule, of what is not said yet: first that all have done well, then for each child that it has not. */
export function added(
  rules: readonly ConcurrencyCondition[],
  children: readonly Pick<EditNode, 'name' | 'outcomes'>[],
): readonly ConcurrencyCondition[] {
  const all = Object.fromEntries(children.flatMap((child) => (child.outcomes[0] ? [[child.name, child.outcomes[0]]] : [])))
  const candidates: ConcurrencyCondition[] = [
    { outcome: 'finished', when: all, at_least: null, preempt: [] },
    ...children.flatMap((child) =>
      child.outcomes.slice(1).map((outcome) => ({
        outcome: 'failed',
        when: { [child.name]: outcome },
        at_least: null,
        preempt: [],
      })),
    ),
  ]
  const present = new Set(rules.filter((rule) => rule.preempt.length === 0).map((rule) => textOf(rule.when)))
  const next = candidates.find((rule) => Object.keys(rule.when).length > 0 && !present.has(textOf(rule.when)))
  return next ? [...rules, next] : [...rules, { outcome: 'finished', when: all, at_least: null, preempt: [] }]
}

function textOf(when: ConcurrencyCondition['when']): string {
  return Object.entries(when)
    .map(([child, outcome]) => `${child}=${outcome}`)
    .toSorted()
    .join()
}
