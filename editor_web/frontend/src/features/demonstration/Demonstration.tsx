/** From demonstration to behavior: choose entries in their order, see what it will do, make it. */
import { Alert, Box, Button, Code, Divider, Flex, Group, List, NativeSelect, SimpleGrid, Text, TextInput, Title } from '@mantine/core'
import { IconAlertTriangle } from '@tabler/icons-react'
import { useEffect, useId, useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { wordsOf } from '../../api/client'
import { propose } from '../../api/demonstration'
import { documents } from '../../api/documents'
import type { EntryName, ProposalBody, ProposalOptions } from '../../api/types'
import { added, bodyOf, type Step } from '../../document/demonstration'
import { fileProblem, idOfFile } from '../../document/editing/fileNames'
import classes from './Demonstration.module.css'
import { EntryChoice } from './EntryChoice'
import { NumberField } from './NumberField'
import { StepList } from './StepList'
import { useProposal, type Proposed } from './useProposal'

export interface DemonstrationProps {
  /** The behavior was written: open it. */
  readonly onMade: (id: string) => void
  /** Steps to begin with. */
  readonly initial?: readonly Step[]
}

const NO_STEPS: readonly Step[] = []

export function Demonstration({ onMade, initial = NO_STEPS }: DemonstrationProps) {
  const [entries, setEntries] = useState<readonly EntryName[]>()
  const [steps, setSteps] = useState(initial)
  const [options, setOptions] = useState<Options>({ arm: '', speed: 0.3, approach_m: 0.1, width_m: null })
  const [refusal, setRefusal] = useState<string>()
  useEffect(() => {
    documents.catalogue().then(
      (catalogue) => setEntries(catalogue.entries),
      (error: unknown) => setRefusal(wordsOf(error)),
    )
  }, [])
  const body = steps.length > 0 ? { options, steps: steps.map(bodyOf) } : undefined
  const proposed = useProposal(body)

  function make(id: string): void {
    if (!body) return
    propose({ ...body, id }).then(
      (made) => onMade(made.id),
      (error: unknown) => setRefusal(wordsOf(error)),
    )
  }

  return (
    <>
      <div className={classes.columns}>
        <EntryChoice entries={entries} onAdd={(kind, name) => setSteps(added(steps, kind, name))} />
        <StepList steps={steps} decided={proposed.proposal?.steps ?? []} parts={proposed.proposal?.parts ?? []} onChange={setSteps} />
        <Flex direction="column" gap="md">
          <OptionFields options={options} arms={proposed.proposal?.arms ?? []} arm={proposed.proposal?.arm} onChange={setOptions} />
          <Preview proposed={proposed} />
        </Flex>
      </div>
      <MakeForm canMake={proposed.proposal !== undefined} refusal={refusal} onMake={make} />
    </>
  )
}

type Options = Required<Pick<ProposalOptions, 'arm' | 'speed' | 'approach_m' | 'width_m'>>

interface OptionFieldsProps {
  readonly options: Options
  readonly arms: readonly string[]
  readonly arm: string | undefined
  readonly onChange: (options: Options) => void
}

function OptionFields({ options, arms, arm, onChange }: OptionFieldsProps) {
  return (
    <SimpleGrid cols={2} spacing="sm" verticalSpacing="xs">
      <NativeSelect
        size="xs"
        label="Arm"
        value={options.arm || arm || ''}
        data={[
          ...(options.arm || arm ? [] : [{ value: '', label: 'by the names' }]),
          ...new Set([...arms, ...(options.arm ? [options.arm] : [])]),
        ]}
        onChange={(event) => onChange({ ...options, arm: event.currentTarget.value })}
      />
      <NumberField
        label="Speed"
        unit="of limits"
        value={options.speed}
        least={0.01}
        most={1}
        onChange={(speed) => onChange({ ...options, speed: speed ?? 0.3 })}
      />
      <NumberField
        label="Approach"
        unit="m"
        value={options.approach_m}
        least={0.001}
        most={0.5}
        onChange={(approach) => onChange({ ...options, approach_m: approach ?? 0.1 })}
      />
      <NumberField
        label="Part width"
        unit="m"
        value={options.width_m}
        least={0}
        most={1}
        onChange={(width) => onChange({ ...options, width_m: width ?? null })}
      />
    </SimpleGrid>
  )
}

/** What the behavior will do, in words. */
function Preview({ proposed }: { proposed: Proposed }) {
  const { proposal, problem } = proposed
  return (
    <Box component="section" className={classes.scroll} flex={1} aria-label="Resulting steps" aria-live="polite">
      <Title order={3} size="sm" mb="xs">
        Resulting steps
      </Title>
      <Refusal>{problem}</Refusal>
      {!proposal && !problem && (
        <Text size="sm" c="dimmed">
          Shown here as soon as there is a step.
        </Text>
      )}
      {proposal && (
        <>
          <List type="ordered" size="sm" spacing={4} mb="sm">
            {proposal.words.map((words, index) => (
              <List.Item key={index}>{words}</List.Item>
            ))}
          </List>
          {warnings(proposal).map((words) => (
            <Alert
              key={words}
              role="note"
              color="yellow"
              bg="var(--stopped-soft)"
              p="xs"
              mb="xs"
              icon={<IconAlertTriangle color="var(--stopped)" aria-hidden />}
            >
              {words}
            </Alert>
          ))}
        </>
      )}
    </Box>
  )
}

function warnings(proposal: ProposalBody): readonly string[] {
  return [...new Set([...proposal.remarks, ...proposal.findings.map((finding) => finding.message)])]
}

interface MakeFormProps {
  readonly canMake: boolean
  readonly refusal: string | undefined
  readonly onMake: (id: string) => void
}

function MakeForm({ canMake, refusal, onMake }: MakeFormProps) {
  const [name, setName] = useState('')
  const [isTried, setTried] = useState(false)
  const field = useId()
  const id = idOfFile('', name.trim().replace(/[^A-Za-z0-9_-]+/g, '_') || 'name', '.yaml')
  const obstacle = canMake ? fileProblem('', name) : 'There is nothing to be done yet'
  const problem = isTried ? (obstacle ?? refusal) : refusal
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault()
        setTried(true)
        if (!obstacle) onMake(id)
      }}
    >
      <Divider my="sm" />
      <Group gap="sm">
        <Text component="label" htmlFor={field} size="sm" fw={550}>
          Name
        </Text>
        <TextInput
          id={field}
          w="15rem"
          value={name}
          placeholder="taught_transfer"
          onChange={(event) => setName(event.currentTarget.value)}
        />
        <Code>{id}</Code>
        <Refusal>{problem}</Refusal>
        <Button type="submit" ml="auto">
          Create and open
        </Button>
      </Group>
    </form>
  )
}
