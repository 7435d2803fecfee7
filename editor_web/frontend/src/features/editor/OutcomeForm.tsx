/** The outcomes of a node in a machine: where each leads, and from which autonomy on it passes by itself. */
import { lookup, without } from '../../document/dict'
import { outgoingTransitions, type EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { connect, disconnect } from './actions'
import { performOn } from './apply'
import { Section } from './Section'
import { declaredOutcomes } from './useArrangement'
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
  return (
    <Section title="Outcomes">
      <table className="edit-table">
        <thead>
          <tr>
            <th scope="col">Outcome</th>
            <th scope="col">Leads to</th>
            <th scope="col">Operator</th>
          </tr>
        </thead>
        <tbody>
          {transitions.map((transition) => (
            <tr key={transition.outcome}>
              <th scope="row" className="mono">
                {transition.outcome}
              </th>
              <td>
                <select
                  className={`plain-input${transition.target === undefined ? ' is-loose' : ''}`}
                  aria-label={`${transition.outcome} leads to`}
                  value={transition.target ?? ''}
                  onChange={(event) => {
                    const target = event.currentTarget.value
                    void (target ? connect(node.path, transition.outcome, target) : disconnect(node.path, transition.outcome))
                  }}
                >
                  <option value="">not connected</option>
                  <optgroup label="Nodes here">
                    {inside.map((name) => (
                      <option key={name} value={name}>
                        {name}
                      </option>
                    ))}
                  </optgroup>
                  <optgroup label={parent === root ? 'Outcomes of the behavior' : `Outcomes of ${parent.name}`}>
                    {ends.map((name) => (
                      <option key={name} value={name}>
                        {name}
                      </option>
                    ))}
                    {transition.target && !inside.includes(transition.target) && !ends.includes(transition.target) && (
                      <option value={transition.target}>{transition.target}</option>
                    )}
                  </optgroup>
                </select>
              </td>
              <td>
                <Autonomy node={node} outcome={transition.outcome} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Section>
  )
}

const NONE: readonly string[] = []

function Autonomy({ node, outcome }: { node: EditNode; outcome: string }) {
  const level = lookup(node.autonomy, outcome) ?? ''
  return (
    <select
      className="plain-input"
      aria-label={`Autonomy of ${outcome}`}
      title={level ? LEVEL_WORDS[level] : 'passes by itself'}
      value={level}
      onChange={({ currentTarget: { value } }) =>
        void performOn(node.path, `Autonomy of ${outcome}`, (now) => {
          const next = value ? { ...now.autonomy, [outcome]: value } : without(now.autonomy, outcome)
          return [setField(node.path, 'autonomy', Object.keys(next).length > 0 ? next : null)]
        })
      }
    >
      <option value="">passes</option>
      {LEVELS.map((each) => (
        <option key={each} value={each}>
          {each}
        </option>
      ))}
    </select>
  )
}
