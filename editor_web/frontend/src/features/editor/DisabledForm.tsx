/** Whether a node is passed over, and with which outcome. */
import { NativeSelect, Switch } from '@mantine/core'
import type { EditNode } from '../../document/editing/model'
import { passWith, toggleDisabled } from './disabled'
import { Section } from './Section'

export function DisabledForm({ node }: { node: EditNode }) {
  const isDisabled = node.disabled !== false
  const outcome = typeof node.disabled === 'string' ? node.disabled : undefined
  const outcomes = outcome === undefined || node.outcomes.includes(outcome) ? node.outcomes : [outcome, ...node.outcomes]
  return (
    <Section title="Disable" isClosed={!isDisabled} note={isDisabled ? 'disabled' : undefined}>
      <div className="edit-line">
        <span>Disabled</span>
        <Switch size="sm" aria-label="Disabled" checked={isDisabled} onChange={() => void toggleDisabled([node.path])} />
      </div>
      {outcome === undefined ? (
        <p className="form-doc">{isDisabled ? 'Its parent passes over it.' : 'A run passes over a disabled node: it is not executed.'}</p>
      ) : (
        <div className="edit-line">
          <span>Passes with</span>
          <NativeSelect
            size="xs"
            aria-label="Passes with"
            value={outcome}
            data={[...outcomes]}
            onChange={(event) => void passWith(node.path, event.currentTarget.value)}
          />
        </div>
      )}
    </Section>
  )
}
