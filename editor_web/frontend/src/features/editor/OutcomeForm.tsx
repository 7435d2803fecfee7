/** The outcomes of a node in a machine: where each leads, and from which autonomy on it passes by itself. */
import { NativeSelect, Table } from '@mantine/core'
import { lookup, without } from '../../document/dict'
import { outgoingTransitions, type EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { connect, disconnect } from './actions'
import { performOn } from './apply'
import { Section } from './Section'
import { declaredOutcomes } from '../../document/editing/expansion'
import { draftOf, rootOf, useEditor } from './store'

const LEVELS = ['off', 'low', 'high', 'full'] as const
const LEVEL_WORDS: Record<string, string> = {
  off: 'asks at every autonomy',
  low: 'asks below low autonomy',
  high: 'asks at low autonomy',
  full: 'asks unless fully autonomous',
}

export function OutcomeForm({ node, parent }: { node: EditNode; parent: EditNode }) {
  const root = useEditor(rootOf)
  const outcomes = useEditor((s) => draftOf(s).document?.outcomes ?? NONE)
  const transitions = outgoingTransitions(parent, node).filter((transition) => transition.isOutcome)
  if (!root || transitions.length === 0) return null
  const inside = parent.children.map((child) => child.name)
  const ends = [...new Set([...declaredOutcomes(root, outcomes)(parent), ...parent.outcomes])].filter((end) => !inside.includes(end))
  const groups = (target: string | undefined) => [
    { group: 'Nodes here', items: inside },
    {
      group: parent === root ? 'Outcomes of the behavior' : `Outcomes of ${parent.name}`,
      items: target && !inside.includes(target) && !ends.includes(target) ? [...ends, target] : ends,
    },
  ]
  return (
    <Section title="Outcomes">
      <Table fz="xs" horizontalSpacing={3} verticalSpacing={2} withRowBorders={false}>
        <Table.Thead c="dimmed">
          <Table.Tr>
            <Table.Th fw={500}>Outcome</Table.Th>
            <Table.Th fw={500}>Leads to</Table.Th>
            <Table.Th fw={500}>Operator</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {transitions.map((transition) => (
            <Table.Tr key={transition.outcome}>
              <Table.Th scope="row" fw={500} ff="monospace" maw="8rem" style={CUT}>
                {transition.outcome}
              </Table.Th>
              <Table.Td>
                <NativeSelect
                  size="xs"
                  error={transition.target === undefined}
                  aria-label={`${transition.outcome} leads to`}
                  value={transition.target ?? ''}
                  data={[{ value: '', label: 'not connected' }, ...groups(transition.target)]}
                  onChange={({ currentTarget: { value: target } }) =>
                    void (target ? connect(node.path, transition.outcome, target) : disconnect(node.path, transition.outcome))
                  }
                />
              </Table.Td>
              <Table.Td>
                <Autonomy node={node} outcome={transition.outcome} />
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </Section>
  )
}

const NONE: readonly string[] = []
const CUT = { overflow: 'hidden', textOverflow: 'ellipsis' } as const

function Autonomy({ node, outcome }: { node: EditNode; outcome: string }) {
  const level = lookup(node.autonomy, outcome) ?? ''
  return (
    <NativeSelect
      size="xs"
      aria-label={`Autonomy of ${outcome}`}
      title={level ? LEVEL_WORDS[level] : 'passes by itself'}
      value={level}
      data={[{ value: '', label: 'passes' }, ...LEVELS]}
      onChange={({ currentTarget: { value } }) =>
        void performOn(node.path, `Autonomy of ${outcome}`, (now) => {
          const next = value ? { ...now.autonomy, [outcome]: value } : without(now.autonomy, outcome)
          return [setField(node.path, 'autonomy', Object.keys(next).length > 0 ? next : null)]
        })
      }
    />
  )
}
