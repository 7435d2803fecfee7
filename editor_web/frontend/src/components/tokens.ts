/** Colours of `app/styles/tokens.css` for what no style sheet draws: canvases, and pictures that leave the page. */

/** Gives a token by its name without dashes: the one of the scheme that the element is shown in. */
export function tokensOf(element: Element): (name: string) => string {
  const style = getComputedStyle(element)
  return (name) => {
    const value = style.getPropertyValue(`--${name}`).trim()
    const [, light = value, dark = value] = /^light-dark\((.+),\s*(.+)\)$/.exec(value) ?? []
    return style.colorScheme.includes('dark') ? dark : light
  }
}
