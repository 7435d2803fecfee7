/** The keys that count on every page: the search, also while somebody writes, and the list of all keys. */
import { useEffect } from 'react'
import { commandOf, showKeys, takeKeptKeys } from '../api/keyMap'
import { openSearch } from '../api/search'
import { isWriting } from '../components/isWriting'
import { isCharacter } from '../document/chord'

export function usePageKeys(): void {
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.defaultPrevented || (isCharacter(event) && isWriting(event.target))) return
      const meant = commandOf(event, 'page')
      if (!meant || (meant === 'sheet' && document.querySelector('dialog[open]'))) return
      event.preventDefault()
      if (meant === 'search') openSearch()
      else showKeys()
    }
    addEventListener('keydown', onKeyDown)
    addEventListener('storage', takeKeptKeys)
    return () => {
      removeEventListener('keydown', onKeyDown)
      removeEventListener('storage', takeKeptKeys)
    }
  }, [])
}
