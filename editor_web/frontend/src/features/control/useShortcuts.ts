/** Keys of the whole page: not while somebody writes, and not while a dialog is open. */
import { useLocalStorage } from '@mantine/hooks'
import { useEffect, useRef } from 'react'
import { shortcutOf, type ShortcutId } from '../../document/shortcuts'

export type Actions = Readonly<Record<ShortcutId, () => void>>

export function useShortcuts(actions: Actions) {
  const [areOn, setOn] = useLocalStorage({ key: 'flexcell.shortcuts', defaultValue: true, getInitialValueInEffect: false })
  const latest = useRef(actions)
  useEffect(() => {
    latest.current = actions
  })
  useEffect(() => {
    if (!areOn) return
    const onKeyDown = (event: KeyboardEvent) => {
      const meant = event.repeat || isWriting(event.target) || document.querySelector('dialog[open]') ? undefined : shortcutOf(event)
      if (!meant) return
      event.preventDefault()
      latest.current[meant]()
    }
    addEventListener('keydown', onKeyDown)
    return () => removeEventListener('keydown', onKeyDown)
  }, [areOn])
  return { areOn, setOn }
}

function isWriting(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false
  const isText = target instanceof HTMLInputElement && !['range', 'checkbox', 'radio', 'button'].includes(target.type)
  return isText || target.isContentEditable || target.matches('textarea, select, [role="textbox"], [role="combobox"]')
}
