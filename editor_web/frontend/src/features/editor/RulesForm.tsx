/** The rules of a concurrency container as a table: a line for each rule, a column for each child. */
import type { ConcurrencyCondition } from '../../api/types'
import { lookup } from '../../document/dict'
import { IconArrowDown, IconArrowUp, IconPlus, IconTrash } from '@tabler/icons-react'
import type { EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { added, conditionsOf, moved, renamedOutcome, withChild, withCount, without, withPreempted } from '../../document/editing/rules'
import { perform, performOn } from './apply'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'

export function RulesForm({ node }: { node: EditNode }) {
  const set = (change: (rules: readonly ConcurrencyCondition[]) => readonly ConcurrencyCondition[], words: string) =>
    void performOn(node.path, words, (now) => [setField(node.path, 'conditions', conditionsOf(change(now.rules)))])
  return (
    <Section title="Ends with" note="the first line that holds">
      <div className="rules-scroll" role="region" aria-label="Rules" tabIndex={0}>
        <table className="edit-table rules-table">
          <thead>
            <tr>
              <th scope="col">Outcome</th>
              <th scope="col">Preempts</th>
              <th scope="col">How many</th>
              {node.children.map((child) => (
                <th scope="col" key={child.name}>
                  {child.name}
                </th>
              ))}
              <th scope="col">
                <span className="visually-hidden">Order</span>
              </th>
            </tr>
          </thead>
          <tbody>
            {node.rules.map((rule, index) => (
              <tr key={index}>
                <td>
                  {rule.preempt.length > 0 ? (
                    <span className="rule-outcome">none, goes on</span>
                  ) : (
                    <TemplateInput
                      label={`Outcome of rule ${index + 1}`}
                      value={rule.outcome}
                      onCommit={(typed) => typed && set((rules) => renamedOutcome(rules, index, typed), `Rule ${index + 1}`)}
                    />
                  )}
                </td>
                <td>
                  <Preempted
                    index={index}
                    rule={rule}
                    names={node.children.map((child) => child.name)}
                    onSet={(child, isPreempted) => set((rules) => withPreempted(rules, index, child, isPreempted), `Rule ${index + 1}`)}
                  />
                </td>
                <td>
                  <select
                    className="plain-input"
                    aria-label={`How many in rule ${index + 1}`}
                    value={rule.at_least ?? Object.keys(rule.when).length}
                    onChange={({ currentTarget: { value } }) => set((rules) => withCount(rules, index, Number(value)), `Rule ${index + 1}`)}
                  >
                    {Object.keys(rule.when).map((name, at) => (
                      <option key={name} value={at + 1}>
                        {at + 1 === Object.keys(rule.when).length ? 'all' : at + 1}
                      </option>
                    ))}
                  </select>
                </td>
                {node.children.map((child) => (
                  <td key={child.name}>
                    <select
                      className="plain-input"
                      aria-label={`${child.name} in rule ${index + 1}`}
                      value={lookup(rule.when, child.name) ?? ''}
                      onChange={({ currentTarget: { value } }) =>
                        set((rules) => withChild(rules, index, child.name, value), `Rule ${index + 1}`)
                      }
                    >
                      <option value="">any</option>
                      {[
                        ...new Set([...child.outcomes, ...(lookup(rule.when, child.name) ? [lookup(rule.when, child.name) ?? ''] : [])]),
                      ].map((outcome) => (
                        <option key={outcome} value={outcome}>
                          {outcome}
                        </option>
                      ))}
                    </select>
                  </td>
                ))}
                <td className="row-tools">
                  <button
                    type="button"
                    className="mini"
                    aria-label={`Move rule ${index + 1} up`}
                    disabled={index === 0}
                    onClick={() => set((rules) => moved(rules, index, -1), 'Order of rules')}
                  >
                    <IconArrowUp size={13} aria-hidden />
                  </button>
                  <button
                    type="button"
                    className="mini"
                    aria-label={`Move rule ${index + 1} down`}
                    disabled={index === node.rules.length - 1}
                    onClick={() => set((rules) => moved(rules, index, 1), 'Order of rules')}
                  >
                    <IconArrowDown size={13} aria-hidden />
                  </button>
                  <button
                    type="button"
                    className="mini"
                    aria-label={`Delete rule ${index + 1}`}
                    onClick={() => set((rules) => without(rules, index), 'Delete a rule')}
                  >
                    <IconTrash size={13} aria-hidden />
                  </button>
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <div className="command-row">
        <button
          type="button"
          className="command"
          disabled={node.children.length === 0}
          onClick={() => set((rules) => added(rules, node.children), 'Add a rule')}
        >
          <IconPlus size={14} aria-hidden /> Add a rule
        </button>
      </div>
      <div className="edit-line">
        <span>Otherwise</span>
        <TemplateInput
          label="Outcome when no rule holds"
          placeholder="none"
          value={node.otherwise ?? ''}
          onCommit={(typed) => void perform('Otherwise', [setField(node.path, 'otherwise', typed || null)])}
        />
      </div>
    </Section>
  )
}

/** Whom a rule preempts while the others go on; everybody, where it decides an outcome. */
function Preempted({
  index,
  rule,
  names,
  onSet,
}: {
  index: number
  rule: ConcurrencyCondition
  names: readonly string[]
  onSet: (child: string, isPreempted: boolean) => void
}) {
  const gone = rule.preempt.filter((name) => !names.includes(name))
  const text = rule.preempt.length > 0 ? rule.preempt.join(', ') : 'all'
  return (
    <details className="rule-preempts">
      <summary aria-label={`${text}: preempted by rule ${index + 1}`}>{text}</summary>
      {[...names, ...gone].map((name) => (
        <label key={name}>
          <input
            type="checkbox"
            checked={rule.preempt.includes(name)}
            onChange={({ currentTarget: { checked } }) => onSet(name, checked)}
          />
          {name}
        </label>
      ))}
    </details>
  )
}
