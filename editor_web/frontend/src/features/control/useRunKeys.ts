/** The keys of the page of a run: not while somebody writes, and not while a dialog is open. */
import { useEffect, useRef } from 'react'
import { commandOf } from '../../api/keyMap'
import { isWriting } from '../../components/isWriting'
import type { RunCommandId } from '../../document/commandTable'

export type RunActions = Readonly<Record<RunCommandId, () => void>>

export function useRunKeys(actions: RunActions): void {
  const latest = useRef(actions)
  useEffect(() => {
    latest.current = actions
  })
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.defaultPrevented || event.repeat || isWriting(event.target) || document.querySelector('dialog[open]')) return
      const meant = commandOf(event, 'run')
      if (!meant) return
      event.preventDefault()
      latest.current[meant]()
    }
    addEventListener('keydown', onKeyDown)
    return () => removeEventListener('keydown', onKeyDown)
  }, [])
}
