/** The rules of a concurrency container as a table: a line for each rule, a column for each child. */
import type { ConcurrencyCondition } from '../../api/types'
import { lookup } from '../../document/dict'
import { Box, Button, Checkbox, Group, NativeSelect, Table, VisuallyHidden } from '@mantine/core'
import { IconArrowDown, IconArrowUp, IconPlus, IconTrash } from '@tabler/icons-react'
import type { EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { added, conditionsOf, moved, renamedOutcome, withChild, withCount, without, withPreempted } from '../../document/editing/rules'
import { perform, performOn } from './apply'
import { FormLine } from './FormParts'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'
import { Tool } from './Tool'

export function RulesForm({ node }: { node: EditNode }) {
  const set = (change: (rules: readonly ConcurrencyCondition[]) => readonly ConcurrencyCondition[], words: string) =>
    void performOn(node.path, words, (now) => [setField(node.path, 'conditions', conditionsOf(change(now.rules)))])
  return (
    <Section title="Ends with" note="the first line that holds">
      <Box role="region" aria-label="Rules" tabIndex={0} style={{ overflowX: 'auto' }}>
        <Table fz="xs" horizontalSpacing={3} verticalSpacing={2} withRowBorders={false}>
          <Table.Thead c="dimmed">
            <Table.Tr>
              <Table.Th fw={500}>Outcome</Table.Th>
              <Table.Th fw={500}>Preempts</Table.Th>
              <Table.Th fw={500}>How many</Table.Th>
              {node.children.map((child) => (
                <Table.Th fw={500} key={child.name}>
                  {child.name}
                </Table.Th>
              ))}
              <Table.Th fw={500}>
                <VisuallyHidden>Order</VisuallyHidden>
              </Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {node.rules.map((rule, index) => (
              <Table.Tr key={index}>
                <Table.Td miw={88}>
                  {rule.preempt.length > 0 ? (
                    'none, goes on'
                  ) : (
                    <TemplateInput
                      label={`Outcome of rule ${index + 1}`}
                      value={rule.outcome}
                      onCommit={(typed) => typed && set((rules) => renamedOutcome(rules, index, typed), `Rule ${index + 1}`)}
                    />
                  )}
                </Table.Td>
                <Table.Td>
                  <Preempted
                    index={index}
                    rule={rule}
                    names={node.children.map((child) => child.name)}
                    onSet={(child, isPreempted) => set((rules) => withPreempted(rules, index, child, isPreempted), `Rule ${index + 1}`)}
                  />
                </Table.Td>
                <Table.Td>
                  <NativeSelect
                    size="xs"
                    miw={80}
                    aria-label={`How many in rule ${index + 1}`}
                    value={rule.at_least ?? Object.keys(rule.when).length}
                    onChange={({ currentTarget: { value } }) => set((rules) => withCount(rules, index, Number(value)), `Rule ${index + 1}`)}
                    data={Object.keys(rule.when).map((_, at) => ({
                      value: String(at + 1),
                      label: at + 1 === Object.keys(rule.when).length ? 'all' : String(at + 1),
                    }))}
                  />
                </Table.Td>
                {node.children.map((child) => (
                  <Table.Td key={child.name}>
                    <NativeSelect
                      size="xs"
                      miw={88}
                      aria-label={`${child.name} in rule ${index + 1}`}
                      value={lookup(rule.when, child.name) ?? ''}
                      onChange={({ currentTarget: { value } }) =>
                        set((rules) => withChild(rules, index, child.name, value), `Rule ${index + 1}`)
                      }
                      data={[
                        { value: '', label: 'any' },
                        ...new Set([...child.outcomes, ...(lookup(rule.when, child.name) ? [lookup(rule.when, child.name) ?? ''] : [])]),
                      ]}
                    />
                  </Table.Td>
                ))}
                <Table.Td>
                  <Group gap={0} wrap="nowrap">
                    <Tool
                      isSmall
                      label={`Move rule ${index + 1} up`}
                      isDisabled={index === 0}
                      onPress={() => set((rules) => moved(rules, index, -1), 'Order of rules')}
                    >
                      <IconArrowUp size={13} aria-hidden />
                    </Tool>
                    <Tool
                      isSmall
                      label={`Move rule ${index + 1} down`}
                      isDisabled={index === node.rules.length - 1}
                      onPress={() => set((rules) => moved(rules, index, 1), 'Order of rules')}
                    >
                      <IconArrowDown size={13} aria-hidden />
                    </Tool>
                    <Tool isSmall label={`Delete rule ${index + 1}`} onPress={() => set((rules) => without(rules, index), 'Delete a rule')}>
                      <IconTrash size={13} aria-hidden />
                    </Tool>
                  </Group>
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </Box>
      <Button
        size="compact-sm"
        variant="default"
        style={{ alignSelf: 'flex-start' }}
        leftSection={<IconPlus size={14} aria-hidden />}
        disabled={node.children.length === 0}
        onClick={() => set((rules) => added(rules, node.children), 'Add a rule')}
      >
        Add a rule
      </Button>
      <FormLine label="Otherwise">
        <TemplateInput
          label="Outcome when no rule holds"
          placeholder="none"
          value={node.otherwise ?? ''}
          onCommit={(typed) => void perform('Otherwise', [setField(node.path, 'otherwise', typed || null)])}
        />
      </FormLine>
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
    <details>
      <summary aria-label={`${text}: preempted by rule ${index + 1}`}>{text}</summary>
      {[...names, ...gone].map((name) => (
        <Checkbox
          key={name}
          size="xs"
          mt={4}
          label={name}
          checked={rule.preempt.includes(name)}
          onChange={({ currentTarget: { checked } }) => onSet(name, checked)}
        />
      ))}
    </details>
  )
}
