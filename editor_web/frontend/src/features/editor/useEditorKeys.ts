/** The keys of the editor: not while somebody writes, apart from those with Ctrl that no field needs. */
import { outcomeOf } from '../../document/edgeId'
import { useEffect, type RefObject } from 'react'
import { neighborOf, type Heading } from '../../document/editing/neighbors'
import { isWriting } from '../../components/isWriting'
import type { Box } from '../../document/geometry'
import { parentPath } from '../../document/path'
import { choose, focusNode } from './actions'
import { commandOf, disabledReason } from './commands'
import { editor, showEditorRefusal } from './store'

const ARROWS: ReadonlySet<string> = new Set(['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'])
/** What holds also while somebody writes in a field. */
const EVERYWHERE: ReadonlySet<string> = new Set(['save', 'run', 'problem'])
/** What a text field does by itself while nothing of the canvas is meant. */
const IN_TEXT: ReadonlySet<string> = new Set(['undo', 'redo'])

export function useEditorKeys(area: RefObject<HTMLElement | null>): void {
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.defaultPrevented || document.querySelector('dialog[open]')) return
      const target = event.target instanceof HTMLElement ? event.target : undefined
      const isText = target !== undefined && isWriting(target)
      if (!isText && ARROWS.has(event.key) && isPlain(event)) {
        if (isOnCanvas(target) && moveTo(area.current, event.key as Heading)) event.preventDefault()
        return
      }
      const command = commandOf(event)
      if (!command) return
      const isCode = target?.closest('.cm-editor') !== null && target !== undefined
      if (isText && !EVERYWHERE.has(command.id) && !(isCode && IN_TEXT.has(command.id))) return
      // Enter and Space on a button press that button.
      if (!isText && target && !isOnCanvas(target) && ['Enter', 'Escape', ' '].includes(event.key) && !event.ctrlKey) return
      if (isText && command.id === 'save') target.blur()
      // What is marked on the page is copied by the browser.
      if (command.id === 'copy' && (getSelection()?.toString() ?? '') !== '') return
      event.preventDefault()
      const obstacle = disabledReason(command)
      if (obstacle) showEditorRefusal(command.words, obstacle)
      else command.run()
    }
    addEventListener('keydown', onKeyDown)
    return () => removeEventListener('keydown', onKeyDown)
  }, [area])

  // A node that gets the keyboard by Tab is the chosen one.
  useEffect(() => {
    const onFocus = (event: FocusEvent) => {
      const node = event.target instanceof HTMLElement && event.target.classList.contains('react-flow__node') ? event.target : undefined
      const path = node?.dataset['id']
      if (path && node?.matches(':focus-visible') && !editor().selection.includes(path)) choose([path])
    }
    const here = area.current
    here?.addEventListener('focusin', onFocus)
    return () => here?.removeEventListener('focusin', onFocus)
  }, [area])
}

function isPlain(event: KeyboardEvent): boolean {
  return !event.ctrlKey && !event.metaKey && !event.altKey && !event.shiftKey
}

function isOnCanvas(target: HTMLElement | undefined): boolean {
  return !target || target === document.body || target.closest('[data-canvas]') !== null || target.tagName === 'MAIN'
}

/** Choose the node that lies in a direction; true when there was one. */
function moveTo(area: HTMLElement | null, heading: Heading): boolean {
  const boxes = new Map<string, Box>()
  for (const element of area?.querySelectorAll<HTMLElement>('.react-flow__node') ?? []) {
    const id = element.dataset['id'] ?? ''
    if (id && !outcomeOf(id)) boxes.set(id, element.getBoundingClientRect())
  }
  const from = editor().selection.at(-1)
  if (!from || !boxes.has(from)) {
    const first = boxes.keys().next().value
    if (first) go(first)
    return first !== undefined
  }
  // Siblings first: what is inside others, or around them, is reached by Enter and Escape.
  const siblings = new Map([...boxes].filter(([id]) => parentPath(id) === parentPath(from)))
  const next = neighborOf(siblings, from, heading) ?? neighborOf(boxes, from, heading)
  if (next) go(next)
  return next !== undefined
}

function go(path: string): void {
  choose([path])
  focusNode(path)
}
