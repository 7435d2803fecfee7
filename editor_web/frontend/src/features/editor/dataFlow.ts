/** The data flow of the draft: fetched while somebody looks at it, and which key is shown on the canvas. */
import { useEffect } from 'react'
import { wordsOf } from '../../api/client'
import { relations } from '../../api/relations'
import type { KeyFlow } from '../../api/types'
import { setEditor, draftOf, useEditor } from './store'
import { reveal } from './session'
import { pageStore } from '../../api/pageStore'

export interface DataFlowState {
  /** Is it drawn on the canvas? */
  readonly isShown: boolean
  /** The key whose arrows are drawn; those of all without. */
  readonly key: string | undefined
  readonly flows: readonly KeyFlow[]
  /** Which text they are of. */
  readonly of: string | undefined
  /** Why nothing is known of the present text. */
  readonly problem: string
}

const NOTHING: DataFlowState = { isShown: false, key: undefined, flows: [], of: undefined, problem: '' }
const PAUSE_MS = 250

export const useDataFlow = pageStore<DataFlowState>(() => NOTHING)

export function toggleDataFlow(): void {
  useDataFlow.setState((state) => ({ isShown: !state.isShown, key: undefined }))
}

/** Draw one key; all where it is the one that is drawn. */
export function showKey(key: string | undefined): void {
  useDataFlow.setState((state) => ({ isShown: true, key: state.key === key ? undefined : key }))
}

export function forgetDataFlow(): void {
  useDataFlow.setState(NOTHING, true)
}

/** Keep the data flow in step with the draft for as long as `isWanted`. */
export function useFreshDataFlow(isNeeded: boolean): void {
  const id = useEditor((s) => s.id)
  const text = useEditor((s) => draftOf(s).text)
  useEffect(() => {
    if (!isNeeded || useDataFlow.getState().of === `${id} ${text}`) return
    let isCurrent = true
    const timer = setTimeout(() => {
      relations.dataFlow(id, text).then(
        (flows) => isCurrent && useDataFlow.setState({ flows, of: `${id} ${text}`, problem: '' }),
        (error: unknown) => isCurrent && useDataFlow.setState({ problem: wordsOf(error) }),
      )
    }, PAUSE_MS)
    return () => {
      isCurrent = false
      clearTimeout(timer)
    }
  }, [isNeeded, id, text])
}

/** Go to where a node says what it reads or writes, and put the keyboard there; to the declarations where it is the behavior. */
export function goToUse(path: string, field: string): void {
  if (path === '') {
    setEditor({ tab: 'document' })
    return
  }
  reveal(path)
  focusField(field)
}

/** The form is drawn a moment after its node is chosen; the canvas takes the keyboard before that. */
function focusField(label: string, tries = 30): void {
  requestAnimationFrame(() => {
    const field = document.querySelector<HTMLElement>(`[data-inspector] :is(input, textarea)[aria-label="${CSS.escape(label)}"]`)
    if (!field) {
      if (tries > 0) focusField(label, tries - 1)
      return
    }
    field.scrollIntoView({ block: 'center' })
    field.focus({ preventScroll: true })
  })
}

export function inputLabel(name: string): string {
  return `Input ${name} is read from`
}

export function outputLabel(name: string): string {
  return `Output ${name} is written to`
}
