/** Tab reaches STOP also while a modal dialog of the kit is open, which would keep the keyboard to itself. */

const TABBABLE = 'a[href], button:not([disabled]), input:not([disabled]), select:not([disabled]), textarea:not([disabled]), [tabindex]'

/** Lead Tab from the last element of the dialog on top to the button, and on to the first; returns how to end it. */
export function letTabReach(button: () => HTMLElement | null): () => void {
  const listen = (event: KeyboardEvent) => {
    const target = button()
    const modal = [...document.querySelectorAll<HTMLElement>('[aria-modal="true"]')].at(-1)
    if (event.key !== 'Tab' || !target || !modal || modal.contains(target)) return
    const inside = [...modal.querySelectorAll<HTMLElement>(TABBABLE)].filter((each) => each.tabIndex >= 0)
    const [leaves, enters] = event.shiftKey ? [inside[0], inside.at(-1)] : [inside.at(-1), inside[0]]
    const active = document.activeElement
    const next = active === target ? (enters ?? target) : active === leaves || !modal.contains(active) ? target : undefined
    if (!next) return
    event.preventDefault()
    // The dialog's own listener would take it back inside.
    event.stopImmediatePropagation()
    next.focus()
  }
  window.addEventListener('keydown', listen, { capture: true })
  return () => window.removeEventListener('keydown', listen, { capture: true })
}
