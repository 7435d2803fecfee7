/** Days as the date fields write them, in the viewer's time zone. Pure. */

/** When a day begins, seconds since 1970; undefined for what is no day. */
export function dayStartS(day: string): number | undefined {
  const at = Date.parse(`${day}T00:00:00`)
  return Number.isFinite(at) && at >= 0 ? at / 1000 : undefined
}

/** When a day is over. */
export function dayEndS(day: string): number | undefined {
  const start = dayStartS(day)
  if (start === undefined) return undefined
  const next = new Date(start * 1000)
  next.setDate(next.getDate() + 1)
  return next.getTime() / 1000
}
