/** Puts the keyboard on the condition of the breakpoint before a node, and sets that breakpoint where there is none. */
import { toggleBreakpoint } from '../../api/breakpoints'

export async function goToCondition(path: string): Promise<void> {
  const field = await next()
  if (field) {
    field.focus()
  } else if (await toggleBreakpoint(path)) {
    const fresh = await next()
    fresh?.focus()
  }
}

/** The field once it is drawn. */
function next(): Promise<HTMLElement | null> {
  return new Promise((found) => {
    requestAnimationFrame(() =>
      requestAnimationFrame(() =>
        found(document.querySelector<HTMLElement>('[data-breakpoints="node"] [data-when="before"] input[type="text"]')),
      ),
    )
  })
}
