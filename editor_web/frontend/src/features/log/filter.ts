/** Which log lines are shown. Pure. */
import type { LogLine } from '../../api/types'

export type Level = 'debug' | 'info' | 'warning' | 'error'

const RANK: Record<string, number> = { debug: 0, info: 1, warning: 2, error: 3 }

export interface Filter {
  readonly level: Level
  readonly text: string
  /** Only this node and what lies inside it; empty for all. */
  readonly path: string
}

/** The lines that pass, in order. */
export function passing(lines: readonly LogLine[], filter: Filter): readonly LogLine[] {
  const least = RANK[filter.level] ?? 0
  const query = filter.text.trim().toLowerCase()
  return lines.filter(
    (line) =>
      (RANK[line.level] ?? 1) >= least &&
      (filter.path === '' || line.path === filter.path || line.path.startsWith(`${filter.path}/`)) &&
      (query === '' || `${line.path} ${line.text} ${line.kind}`.toLowerCase().includes(query)),
  )
}
