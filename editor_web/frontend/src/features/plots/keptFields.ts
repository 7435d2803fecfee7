/** The numbers that were chosen last, kept by the browser. */

export const MOST_CURVES = 32
const KEPT = 'flexcell.plots'

export function keptFields(): readonly string[] {
  try {
    const fields: unknown = JSON.parse(localStorage.getItem(KEPT) ?? '[]')
    return Array.isArray(fields) ? fields.filter((each): each is string => typeof each === 'string').slice(0, MOST_CURVES) : []
  } catch {
    // What somebody else has written there is no reason not to start.
    return []
  }
}

export function keepFields(fields: readonly string[]): void {
  localStorage.setItem(KEPT, JSON.stringify(fields))
}
