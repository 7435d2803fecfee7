/** The browser's modal dialogs: which one is on top, as nothing outside of it can be reached while it is open. */
import { useLayoutEffect, type RefObject } from 'react'
import { pageStore } from '../api/pageStore'

const useOpen = pageStore<{ readonly dialogs: readonly HTMLDialogElement[] }>(() => ({ dialogs: [] }))

/** Open the dialog over everything else, for as long as it is shown. */
export function useModal(element: RefObject<HTMLDialogElement | null>, isShown = true): void {
  useLayoutEffect(() => {
    const dialog = element.current
    if (!isShown || !dialog) return
    const focused = document.activeElement
    if (!dialog.open) dialog.showModal()
    useOpen.setState(({ dialogs }) => ({ dialogs: [...dialogs, dialog] }))
    return () => {
      useOpen.setState(({ dialogs }) => ({ dialogs: dialogs.filter((each) => each !== dialog) }))
      focusAgain(focused)
    }
  }, [element, isShown])
}

/** A browser gives the focus back when a dialog is closed, and not when it is taken out of the page. */
function focusAgain(element: Element | null): void {
  const isNowhere = document.activeElement === document.body || document.activeElement === null
  if (isNowhere && element instanceof HTMLElement && element.isConnected) element.focus()
}

/** Where something stands that must be reachable at any time: in the dialog on top, else in the page. */
export function useTop(): HTMLElement {
  return useOpen(({ dialogs }) => dialogs.at(-1) ?? document.body)
}
