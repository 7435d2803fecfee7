/** The steps that a behavior is proposed from: taught entries in their order, and actions of the tool. Pure. */
import type { EntryName, TaughtStep } from '../api/types'

export type Role = NonNullable<TaughtStep['role']>
export type Kind = TaughtStep['kind']

export interface Step {
  /** Tells two steps of the same entry apart. */
  readonly key: number
  readonly kind: Kind
  readonly name: string
  /** Chosen by a person; guessed otherwise. */
  readonly role?: Role
  /** What a grasp takes, chosen by a person; empty for something without a name. */
  readonly part?: string
}

export const ROLE_WORDS: Readonly<Record<Role, string>> = {
  via: 'Move there',
  approach: 'Approach',
  grasp: 'Grasp',
  release: 'Release',
  depart: 'Depart',
  follow: 'Follow',
  open: 'Open',
  close: 'Close',
}

export const KIND_WORDS: Readonly<Record<Kind, string>> = {
  joints: 'joints',
  pose: 'pose',
  trajectory: 'recording',
  dmp: 'motion',
  cart_dmp: 'tool motion',
  gripper: 'gripper',
  action: 'gripper',
}

const PLACES: readonly Role[] = ['via', 'approach', 'grasp', 'release', 'depart']

/** What a step of this kind can be for. */
export function rolesOf(kind: Kind): readonly Role[] {
  if (kind === 'joints' || kind === 'pose') return PLACES
  return kind === 'gripper' || kind === 'action' ? ['open', 'close'] : ['follow']
}

/** The entries that a motion can be made of. */
export function teachable(entries: readonly EntryName[]): readonly (EntryName & { kind: Kind })[] {
  return entries.filter((entry): entry is EntryName & { kind: Kind } => entry.kind in KIND_WORDS)
}

export function added(steps: readonly Step[], kind: Kind, name: string): readonly Step[] {
  return [...steps, { key: 1 + Math.max(0, ...steps.map((step) => step.key)), kind, name }]
}

export function bodyOf({ kind, name, role, part }: Step): TaughtStep {
  return { kind, name, ...(role ? { role } : {}), ...(part === undefined ? {} : { part }) }
}

/** Whether a step takes something: a grasp, or the tool that closes with no grasp before it. */
export function takes(step: TaughtStep, before: TaughtStep | undefined): boolean {
  return step.role === 'grasp' || (step.role === 'close' && before?.role !== 'grasp')
}
