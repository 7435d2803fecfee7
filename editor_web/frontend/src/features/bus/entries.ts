/** What a bus has, by kind. */
import type { Named } from '../../document/busTree'
import type { BusListing } from '../../api/types'

export type BusKind = 'topics' | 'services' | 'actions' | 'parameters' | 'leases'

export const KINDS: { value: BusKind; label: string }[] = [
  { value: 'topics', label: 'Topics' },
  { value: 'services', label: 'Services' },
  { value: 'actions', label: 'Actions' },
  { value: 'parameters', label: 'Parameters' },
  { value: 'leases', label: 'Leases' },
]

export function entriesOf(board: BusListing, kind: BusKind): readonly Named[] {
  switch (kind) {
    case 'topics':
      return board.topics
    case 'services':
      return board.skills.filter((skill) => skill.kind === 'service')
    case 'actions':
      return board.skills.filter((skill) => skill.kind === 'action')
    case 'parameters':
      return board.parameters.map(({ name, doc, value }) => ({ name, doc, type: JSON.stringify(value) }))
    case 'leases':
      return []
  }
}
