/** A copy of a behavior for the connected cell: what each name becomes, what stays open, and the new document. */
import { Badge, Button, Code, Group, Select, Stack, Table, Text, TextInput, Title, VisuallyHidden } from '@mantine/core'
import { useMutation } from '@tanstack/react-query'
import { useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { adaptation, adaptationQuery, type NameChoices } from '../../api/adaptation'
import { problemOf, useLastAnswer } from '../../api/queryClient'
import type { AdaptationBody, AdaptationPlan, FindingView, MappedName } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { Words } from '../../components/Words'
import { isError } from '../../document/editing/findings'
import { statusOf } from '../../document/runState'

export interface AdaptationProps {
  readonly behavior: string
  /** The new document is there. */
  readonly onMade: (id: string) => void
}

export function Adaptation({ behavior, onMade }: AdaptationProps) {
  const [names, setNames] = useState<NameChoices>({})
  const { value: made, problem } = useLastAnswer(adaptationQuery(behavior, names))
  return (
    <Stack gap="sm">
      <Refusal>{problem}</Refusal>
      {!made && !problem && <Text role="status">Comparing the cells</Text>}
      {made && (
        <>
          <Text size="sm" c="var(--quiet)">
            Written for the cell {made.plan.own_cell}. A copy for {made.plan.cell} is made; this behavior stays as it is.
          </Text>
          <Names plan={made.plan} onChoose={(key, target) => setNames({ ...names, [key]: target })} />
          <Open plan={made.plan} />
          <Make key={made.id} behavior={behavior} made={made} names={names} onMade={onMade} />
        </>
      )}
    </Stack>
  )
}

function Names({ plan, onChoose }: { readonly plan: AdaptationPlan; readonly onChoose: (key: string, target: string) => void }) {
  if (plan.names.length === 0) return <Text size="sm">It names nothing of its cell.</Text>
  return (
    <Table aria-label="What each name becomes" verticalSpacing={4} horizontalSpacing="xs" fz="sm">
      <Table.Thead>
        <Table.Tr>
          <Table.Th>In {plan.own_cell}</Table.Th>
          <Table.Th w="46%">In {plan.cell}</Table.Th>
          <Table.Th>Why</Table.Th>
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {plan.names.map((each) => (
          <NameRow key={`${each.kind}:${each.name}`} name={each} onChoose={(target) => onChoose(`${each.kind}:${each.name}`, target)} />
        ))}
      </Table.Tbody>
    </Table>
  )
}

function NameRow({ name, onChoose }: { readonly name: MappedName; readonly onChoose: (target: string) => void }) {
  const { kind, candidates, target } = name
  const options = candidates.map((each) => ({ value: each.name, label: each.detail ? `${each.name} (${each.detail})` : each.name }))
  return (
    <Table.Tr data-name={`${kind}:${name.name}`} data-open={target === '' || undefined}>
      <Table.Td>
        <Group gap="3xs" wrap="nowrap">
          <Badge variant="default" size="sm" radius="sm" tt="none" flex="none">
            {kind}
          </Badge>
          <Text span inherit fw={600}>
            {name.name}
          </Text>
        </Group>
        <Text size="xs" c="var(--quiet)">
          {[name.detail, placesOf(name)].filter(Boolean).join(' · ')}
        </Text>
      </Table.Td>
      <Table.Td>
        <Select
          size="xs"
          aria-label={`${kind} ${name.name} becomes`}
          placeholder={candidates.length === 0 ? `No ${kind} fits; the name stays` : 'The name stays'}
          data={options}
          value={target || null}
          disabled={candidates.length === 0}
          searchable={candidates.length > 7}
          clearable
          clearButtonProps={{ 'aria-label': `Keep the name ${name.name}` }}
          comboboxProps={{ withinPortal: false }}
          onChange={(chosen) => onChoose(chosen ?? '')}
        />
      </Table.Td>
      <Table.Td>
        <Text size="xs" c={target === '' ? 'var(--stopped)' : 'var(--quiet)'}>
          {name.reason || (target === '' ? 'stays as it is' : 'selected')}
        </Text>
      </Table.Td>
    </Table.Tr>
  )
}

function placesOf({ paths }: MappedName): string {
  return paths.length === 0 ? 'a default' : `${paths.length} ${paths.length === 1 ? 'node' : 'nodes'}`
}

/** What the check says of the adapted text, and names that only a run makes. */
function Open({ plan }: { readonly plan: AdaptationPlan }) {
  const { findings, undecided } = plan
  if (findings.length === 0 && undecided.length === 0) {
    return (
      <Text size="sm" role="status">
        The check finds nothing in the adapted behavior.
      </Text>
    )
  }
  return (
    <Stack gap="4xs">
      <Title order={3} size="sm">
        <span role="status">Stays open: {countsOf(findings, undecided.length)}</span>
      </Title>
      <ul className="plain-list" aria-label="Stays open">
        {findings.map((finding, index) => (
          <li key={index}>
            <Group gap="2xs" wrap="nowrap" align="flex-start" fz="xs">
              <StatusIcon status={statusOf(finding.severity)} size={14} />
              <span>
                <VisuallyHidden component="span">{finding.severity}: </VisuallyHidden>
                <Words text={finding.message} /> <Code fz="xs">{finding.path}</Code>
              </span>
            </Group>
          </li>
        ))}
        {undecided.map(({ path, expression }) => (
          <li key={`${path} ${expression}`}>
            <Text size="xs">
              A run decides the name <Code fz="xs">{expression}</Code> in <Code fz="xs">{path}</Code>
            </Text>
          </li>
        ))}
      </ul>
    </Stack>
  )
}

function countsOf(findings: readonly FindingView[], undecided: number): string {
  const errors = findings.filter(isError).length
  const counts = [
    [errors, 'error'],
    [findings.length - errors, 'warning'],
    [undecided, 'expression'],
  ] as const
  const named = counts.filter(([count]) => count > 0)
  return named.map(([count, word]) => `${count} ${word}${count === 1 ? '' : 's'}`).join(', ')
}

function Make({ behavior, made, names, onMade }: AdaptationProps & { readonly made: AdaptationBody; readonly names: NameChoices }) {
  const [id, setId] = useState(made.id)
  const [name, setName] = useState(made.name)
  const writing = useMutation({
    mutationFn: () => adaptation.write(behavior, { id, name, names }),
    onSuccess: (document) => onMade(document.id),
  })
  const problem = problemOf(writing.error)
  return (
    <Stack
      component="form"
      gap="sm"
      onSubmit={(event) => {
        event.preventDefault()
        writing.mutate()
      }}
    >
      <Group gap="sm" grow align="flex-start">
        <TextInput size="xs" label="Name" value={name} onChange={(event) => setName(event.currentTarget.value)} />
        <TextInput size="xs" label="File" value={id} onChange={(event) => setId(event.currentTarget.value)} />
      </Group>
      {made.copies.length > 0 && (
        <Text size="xs" c="var(--quiet)">
          Behaviors inside it name things of the other cell too; copies of them are made: {made.copies.join(', ')}
        </Text>
      )}
      <Refusal>{problem}</Refusal>
      <Group gap="xs">
        <Button type="submit" size="sm" loading={writing.isPending}>
          Create and open
        </Button>
      </Group>
    </Stack>
  )
}
