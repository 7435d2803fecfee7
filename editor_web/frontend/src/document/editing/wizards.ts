/** Which wizard teaches a value, by what its type says of it. Pure. */
import type { EditField } from './fields'

export type WizardKind = 'pose' | 'joints' | 'region' | 'waypoints'

/** The wizard of a field; undefined where it has none. */
export function wizardOf(field: EditField): WizardKind | undefined {
  if (field.jointsOf) return 'joints'
  const parts = field.item?.properties.map(wizardOf) ?? []
  if (parts.includes('joints') && parts.includes('pose')) return 'waypoints'
  const names = new Set(field.properties.map((each) => each.name))
  if (names.has('xyz') && (names.has('xyzw') || names.has('rpy'))) return 'pose'
  return names.has('center_m') && names.has('size_m') ? 'region' : undefined
}

/** How the turn of a pose is written. */
export function turnForm(field: EditField): 'xyzw' | 'rpy' {
  return field.properties.some((each) => each.name === 'xyzw') ? 'xyzw' : 'rpy'
}
