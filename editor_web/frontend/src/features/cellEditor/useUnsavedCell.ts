/** The browser warns before the page goes with changes that are not saved. */
import { useEffect } from 'react'
import { cellEditor, isDirty } from './store'

export function useUnsavedCell(): void {
  useEffect(() => {
    const warn = (event: BeforeUnloadEvent) => {
      if (isDirty(cellEditor())) event.preventDefault()
    }
    addEventListener('beforeunload', warn)
    return () => removeEventListener('beforeunload', warn)
  }, [])
}
