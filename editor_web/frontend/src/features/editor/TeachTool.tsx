/** Opens the wizard that teaches the value of a parameter; nothing where its type has none. */
import { IconWand } from '@tabler/icons-react'
import { askWizard } from '../../api/valueWizard'
import { lookup } from '../../document/dict'
import type { EditField } from '../../document/editing/fields'
import type { EditNode } from '../../document/editing/model'
import { offersOf, type Surroundings } from '../../document/editing/offers'
import { armOf, byDefault } from '../../document/editing/preview'
import { turnForm, wizardOf } from '../../document/editing/wizards'
import { Tool } from './Tool'

interface TeachToolProps {
  readonly node: EditNode
  readonly field: EditField
  readonly value: unknown
  readonly around: Surroundings
  readonly onSet: (value: unknown) => void
}

export function TeachTool({ node, field, value, around, onSet }: TeachToolProps) {
  const kind = wizardOf(field)
  if (kind === undefined) return null
  const request = {
    title: `${field.name} of ${node.name}`,
    arm: armOf(node.parameters, around.parameters),
    value: value ?? field.fallback,
    onSet,
  }
  return (
    <Tool isSmall label={`Teach ${field.name}`} title="Teach it on the cell" onPress={open}>
      <IconWand size={13} aria-hidden />
    </Tool>
  )

  function open(): void {
    if (kind === 'waypoints') {
      const entries = around.entries.filter((each) => each.kind === 'joints' || each.kind === 'pose')
      return askWizard({ ...request, kind, entries })
    }
    if (kind !== 'pose') return askWizard({ ...request, kind: kind ?? 'joints' })
    const frame = field.properties.find((each) => each.name === 'frame')
    const own = new Set(frame?.namesBeside)
    askWizard({
      ...request,
      kind: 'pose',
      form: turnForm(field),
      frames: frame ? (offersOf(frame, around) ?? []).map((each) => each.text) : [],
      meant: (name) => (own.has(name) ? given(name) : name),
    })
  }

  /** What another parameter of the node names, by default. */
  function given(name: string): string {
    const other = lookup(node.parameters, name)
    return typeof other === 'string' ? (byDefault(other, around.parameters) ?? '') : ''
  }
}
