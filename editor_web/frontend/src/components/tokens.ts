/** Colours of `app/styles/tokens.css` for what no style sheet draws: canvases, and pictures that leave the page. */

/** Gives a token by its name without dashes: the one of the scheme that the element is shown in. */
export function tokensOf(element: Element): (name: string) => string {
  const style = getComputedStyle(element)
  return (name) => {
    return ofScheme(style.getPropertyValue(`--${name}`).trim(), style.colorScheme.includes('dark'))
  }
}

/** Gives a token by its name without dashes, from the text of the style sheet: where there is no element to ask. */
export function schemeTokens(sheet: string, scheme: 'light' | 'dark'): (name: string) => string {
  // Those for more contrast and for the system's own colours follow in media queries.
  const [plain = ''] = sheet.split('@media')
  const values = new Map([...plain.matchAll(/--([\w-]+):\s*([^;]+);/g)].map(([, name = '', value = '']) => [name, value]))
  return (name) => {
    const value = values.get(name)
    if (value === undefined) throw new Error(`there is no token --${name}`)
    return ofScheme(value.trim(), scheme === 'dark')
  }
}

function ofScheme(value: string, isDark: boolean): string {
  const [, light = value, dark = value] = /^light-dark\((.+),\s*(.+)\)$/.exec(value) ?? []
  return isDark ? dark : light
}
