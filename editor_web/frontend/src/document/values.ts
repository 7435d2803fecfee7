/** Values in a line: what is short enough to need no unfolding, and how it is written. Pure. */

const SHORT = 64
const DIGITS = 5

/** Does a value stand on one line? */
export function isShort(value: unknown): boolean {
  if (typeof value !== 'object' || value === null) return true
  const parts = Object.values(value)
  if (parts.length === 0) return true
  if (parts.some((part) => typeof part === 'object' && part !== null)) return false
  return Array.isArray(value) && written(value).length <= SHORT
}

/** A value in a line: whole where it is short, else how much there is of it. */
export function inShort(value: unknown): string {
  if (typeof value !== 'object' || value === null) return scalar(value)
  if (isShort(value)) return written(value)
  const count = Object.keys(value).length
  return Array.isArray(value) ? `${count} items` : `${count} ${count === 1 ? 'field' : 'fields'}`
}

function written(value: object): string {
  if (Array.isArray(value)) return `[${value.map(scalar).join(', ')}]`
  return Object.keys(value).length === 0 ? '{}' : JSON.stringify(value)
}

function scalar(value: unknown): string {
  if (typeof value === 'number') return numeral(value)
  if (typeof value === 'string') return value === '' ? '""' : value
  return value === null ? 'none' : plainText(value)
}

/** What a value is, in a word: `a number`, `a list`. */
export function kindOfValue(value: unknown): string {
  if (value === null) return 'nothing'
  if (Array.isArray(value)) return 'a list'
  switch (typeof value) {
    case 'number':
      return 'a number'
    case 'boolean':
      return 'true or false'
    case 'string':
      return 'text'
    default:
      return 'a mapping'
  }
}

/** Text as it is, anything else as JSON; undefined is empty. */
export function plainText(value: unknown): string {
  return typeof value === 'string' ? value : (JSON.stringify(value) ?? '')
}

/** Text of a source file with its paragraphs and lists, and without the ends of its lines. */
export function flowing(text: string): string {
  return text.replaceAll(/(\S)[ \t]*\n(?!\s*(?:\n|[-*] ))\s*/g, '$1 ')
}

/** A number with at most five significant digits behind the point. */
export function numeral(value: number): string {
  if (Number.isInteger(value)) return String(value)
  const size = Math.abs(value)
  if (size >= 1e6 || size < 1e-4) return value.toExponential(3)
  return String(Number(value.toPrecision(Math.max(DIGITS, Math.ceil(Math.log10(size)) + 3))))
}
