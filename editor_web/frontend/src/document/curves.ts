/** The samples of several curves over one time, in a ring of fixed size. Pure but for the ring itself. */
import { lookup, type Dict } from './dict'

export class Curves {
  private times: Float64Array
  private columns = new Map<string, Float64Array>()
  private order: readonly string[] = []
  private head = 0
  private filled = 0

  constructor(readonly capacity: number) {
    this.times = new Float64Array(capacity)
  }

  /** Rows that are kept. */
  get length(): number {
    return this.filled
  }

  get names(): readonly string[] {
    return this.order
  }

  /** Keep these curves; what was sampled of those that stay is kept, new ones begin with gaps. */
  choose(names: readonly string[]): void {
    const before = this.columns
    this.columns = new Map(names.map((name) => [name, before.get(name) ?? new Float64Array(this.capacity).fill(NaN)]))
    this.order = names
  }

  /** Add a row, a value for each chosen curve in their order; the oldest row gives way. Time never goes back. */
  push(timeS: number, values: readonly (number | null)[]): void {
    if (this.filled > 0 && timeS <= this.time(this.filled - 1)) return
    this.times[this.head] = timeS
    this.order.forEach((name, index) => {
      const column = this.columns.get(name)
      if (column) column[this.head] = values[index] ?? NaN
    })
    this.head = (this.head + 1) % this.capacity
    this.filled = Math.min(this.capacity, this.filled + 1)
  }

  /** The time of a row; row 0 is the oldest. */
  time(row: number): number {
    return this.times[this.place(row)] ?? NaN
  }

  /** A value; NaN where there is none. */
  value(name: string, row: number): number {
    return this.columns.get(name)?.[this.place(row)] ?? NaN
  }

  /** The first row at or after a time; `length` where there is none. */
  rowAt(timeS: number): number {
    let low = 0
    let high = this.filled
    while (low < high) {
      const middle = (low + high) >> 1
      if (this.time(middle) < timeS) low = middle + 1
      else high = middle
    }
    return low
  }

  /** The row that is nearest to a time; undefined where there are none. */
  nearest(timeS: number): number | undefined {
    if (this.filled === 0) return undefined
    const after = Math.min(this.filled - 1, this.rowAt(timeS))
    const before = Math.max(0, after - 1)
    return timeS - this.time(before) < this.time(after) - timeS ? before : after
  }

  /** One that stays as this is now. */
  copy(): Curves {
    const made = new Curves(this.capacity)
    made.times = this.times.slice()
    made.columns = new Map([...this.columns].map(([name, column]) => [name, column.slice()]))
    made.order = this.order
    made.head = this.head
    made.filled = this.filled
    return made
  }

  private place(row: number): number {
    return (this.head - this.filled + row + this.capacity) % this.capacity
  }
}

/** All rows as CSV: their times in seconds, then a column for each curve. */
export function csvOf(curves: Curves, headings: Dict<string>): string {
  const quoted = (text: string) => `"${text.replaceAll('"', '""')}"`
  const lines = [['time_s', ...curves.names.map((name) => quoted(lookup(headings, name) ?? name))].join(',')]
  for (let row = 0; row < curves.length; row += 1) {
    const values = curves.names.map((name) => {
      const value = curves.value(name, row)
      return Number.isNaN(value) ? '' : String(value)
    })
    lines.push([curves.time(row).toFixed(3), ...values].join(','))
  }
  return `${lines.join('\r\n')}\r\n`
}
