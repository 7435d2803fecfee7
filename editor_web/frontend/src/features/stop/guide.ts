/** Whether this page shows the recovery guide; kept over a reload of the page. */
import { pageStore } from '../../api/pageStore'

const KEY = 'flexcell.recovery-guide'

export const useGuide = pageStore<{ readonly isOpen: boolean }>(() => ({ isOpen: sessionStorage.getItem(KEY) === 'open' }))

export function openGuide(isOpen: boolean): void {
  sessionStorage.setItem(KEY, isOpen ? 'open' : '')
  useGuide.setState({ isOpen })
}
