/** The key of STOP: it works everywhere, also while somebody writes, in dialogs and in the 3D view. */
import { stopCell } from '../api/stopCell'
import { useSession } from '../api/session'

export const STOP_KEY = 'Ctrl+Shift+Backspace'

/** It was pressed where this page hears no keys. */
export function stopByKey(): void {
  if (mayStop()) stopCell()
}

/** Listen for it before anything else of the page does; returns how to end it. */
export function listenForStopKey(): () => void {
  const listen = (event: KeyboardEvent) => {
    const isMeant = event.key === 'Backspace' && event.ctrlKey && event.shiftKey && !event.altKey
    if (!isMeant || !mayStop()) return
    event.preventDefault()
    event.stopImmediatePropagation()
    if (!event.repeat) stopCell()
  }
  window.addEventListener('keydown', listen, { capture: true })
  return () => window.removeEventListener('keydown', listen, { capture: true })
}

function mayStop(): boolean {
  return useSession.getState().session?.role === 'operator'
}
