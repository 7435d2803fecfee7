/** The keys of the editor of the cell, and the browser's warning before the page goes with changes that are not saved. */
import { useEffect } from 'react'
import { isWriting } from '../../components/isWriting'
import { redo, undo } from './session'
import { cellEditor, isDirty } from './store'

/** `onSave` saves, by Ctrl+S also out of a field. */
export function useCellKeys(onSave: () => void): void {
  useEffect(() => {
    const warn = (event: BeforeUnloadEvent) => {
      if (isDirty(cellEditor())) event.preventDefault()
    }
    const press = (event: KeyboardEvent) => {
      if (event.defaultPrevented || event.altKey || !(event.ctrlKey || event.metaKey) || cellEditor().phase !== 'ready') return
      const key = event.key.toLowerCase()
      const act =
        key === 's'
          ? onSave
          : isWriting(event.target)
            ? undefined
            : key === 'z'
              ? event.shiftKey
                ? redo
                : undo
              : key === 'y'
                ? redo
                : undefined
      if (!act) return
      event.preventDefault()
      act()
    }
    addEventListener('beforeunload', warn)
    addEventListener('keydown', press)
    return () => {
      removeEventListener('beforeunload', warn)
      removeEventListener('keydown', press)
    }
  })
}
