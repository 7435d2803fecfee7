/** Undo and redo: the texts of a document, one after the other, each with the words of what made it. Pure. */
import type { Draft } from './model'

/** What a history needs to know of a draft. */
interface Written {
  readonly text: string
}

export interface Step<D extends Written = Draft> {
  /** What was done to get here, `Rename grasp`. */
  readonly label: string
  readonly draft: D
  /** Steps of the same burst, typing in one place, are one. */
  readonly burst: string
}

export interface History<D extends Written = Draft> {
  readonly steps: readonly Step<D>[]
  readonly at: number
}

const LIMIT = 1000

export function newHistory<D extends Written>(draft: D): History<D> {
  return { steps: [{ label: 'Opened', draft, burst: '' }], at: 0 }
}

export function presentOf<D extends Written>(history: History<D>): Step<D> {
  const step = history.steps[history.at]
  if (!step) throw new Error('a history has at least one step')
  return step
}

/** Go on with another draft; what was undone is gone. Within one `burst` the last step is replaced. */
export function pushed<D extends Written>(history: History<D>, label: string, draft: D, burst = ''): History<D> {
  const now = presentOf(history)
  if (draft.text === now.draft.text) return replaced(history, draft)
  const goesOn = burst !== '' && now.burst === burst && history.at > 0
  const kept = history.steps.slice(Math.max(0, history.at + 1 - LIMIT), history.at + (goesOn ? 0 : 1))
  const steps = [...kept, { label, draft, burst }]
  return { steps, at: steps.length - 1 }
}

/** The same text, with what the server now says of it. */
export function replaced<D extends Written>(history: History<D>, draft: D): History<D> {
  return { ...history, steps: history.steps.map((step, index) => (index === history.at ? { ...step, draft } : step)) }
}

/** End a burst, so that what is typed next is a step of its own. */
export function settled<D extends Written>(history: History<D>): History<D> {
  return {
    ...history,
    steps: history.steps.map((step, index) => (index === history.at ? { ...step, burst: '' } : step)),
  }
}

export function canUndo(history: { readonly at: number }): boolean {
  return history.at > 0
}

export function canRedo(history: { readonly at: number; readonly steps: readonly unknown[] }): boolean {
  return history.at < history.steps.length - 1
}

export function undone<D extends Written>(history: History<D>): History<D> {
  return canUndo(history) ? { ...history, at: history.at - 1 } : history
}

export function redone<D extends Written>(history: History<D>): History<D> {
  return canRedo(history) ? { ...history, at: history.at + 1 } : history
}

/** Go to a step; the others stay, before and after it. */
export function jumped<D extends Written>(history: History<D>, at: number): History<D> {
  return { ...history, at: Math.max(0, Math.min(history.steps.length - 1, at)) }
}
