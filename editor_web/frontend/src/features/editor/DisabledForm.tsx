/** Whether a node is passed over, and with which outcome. */
import { NativeSelect, Switch } from '@mantine/core'
import type { EditNode } from '../../document/editing/model'
import { passWith, toggleDisabled } from './disabled'
import { FormLine, FormWords } from './FormParts'
import { Section } from './Section'

export function DisabledForm({ node }: { node: EditNode }) {
  const isDisabled = node.disabled !== false
  const outcome = typeof node.disabled === 'string' ? node.disabled : undefined
  const outcomes = outcome === undefined || node.outcomes.includes(outcome) ? node.outcomes : [outcome, ...node.outcomes]
  return (
    <Section title="Disable" isClosed={!isDisabled} note={isDisabled ? 'disabled' : undefined}>
      <FormLine label="Disabled">
        <Switch size="sm" aria-label="Disabled" checked={isDisabled} onChange={() => void toggleDisabled([node.path])} />
      </FormLine>
      {outcome === undefined ? (
        <FormWords>{isDisabled ? 'Its parent passes over it.' : 'A run passes over a disabled node: it is not executed.'}</FormWords>
      ) : (
        <FormLine label="Passes with">
          <NativeSelect
            size="xs"
            aria-label="Passes with"
            value={outcome}
            data={[...outcomes]}
            onChange={(event) => void passWith(node.path, event.currentTarget.value)}
          />
        </FormLine>
      )}
    </Section>
  )
}
