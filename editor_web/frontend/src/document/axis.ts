/** Where an axis has its marks, and the range that shows values well. Pure. */

/** Round steps of 1, 2 or 5 that give at most `most` marks within the range. */
export function marksOf(low: number, high: number, most: number): readonly number[] {
  const rough = (high - low) / Math.max(1, most)
  if (!(rough > 0) || !Number.isFinite(rough)) return []
  const power = 10 ** Math.floor(Math.log10(rough))
  const step = power * ([1, 2, 5, 10].find((factor) => factor * power >= rough) ?? 10)
  const first = Math.ceil(low / step - 1e-9)
  const last = Math.floor(high / step + 1e-9)
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, index) => Number(((first + index) * step).toPrecision(12)))
}

/** A range with some room above and below; a constant gets a range around it. */
export function rangeAround(low: number, high: number): readonly [number, number] {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1]
  const room = high > low ? (high - low) * 0.08 : Math.max(Math.abs(high) * 0.05, 1e-3)
  return [low - room, high + room]
}

/** A mark of time before the end: `−10 s`, `−1:30`. */
export function agoText(beforeS: number): string {
  if (beforeS < 0.05) return '0 s'
  if (beforeS < 60) return `−${Number(beforeS.toFixed(1))} s`
  return `−${Math.floor(beforeS / 60)}:${String(Math.round(beforeS % 60)).padStart(2, '0')}`
}
