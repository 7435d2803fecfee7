/** Whether this page shows the recovery guide; kept over a reload of the page. */
import { create } from 'zustand'

const KEY = 'flexcell.recovery-guide'

export const useGuide = create<{ readonly isOpen: boolean }>(() => ({ isOpen: sessionStorage.getItem(KEY) === 'open' }))

export function openGuide(isOpen: boolean): void {
  sessionStorage.setItem(KEY, isOpen ? 'open' : '')
  useGuide.setState({ isOpen })
}
