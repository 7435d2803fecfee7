/** Making a sweep: what is executed, how often, what is varied and what is required; it becomes a document. */
import { Button, Fieldset, Group, NativeSelect, Stack, Text, TextInput } from '@mantine/core'
import { IconPlus } from '@tabler/icons-react'
import { useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { behaviorQueries } from '../../api/behaviorQueries'
import { wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { sweepQueries, sweepsApi } from '../../api/sweeps'
import { Dialog } from '../../components/Dialog'
import { documentOf, proposedId, type FactorDraft, type SweepDraft } from '../../document/sweeps'
import { FactorFields, NO_FACTOR } from './FactorFields'
import { NEW_SEARCH, SearchFields } from './SearchFields'
import { Note } from './Note'

export interface NewSweepProps {
  /** The sweeps that there are. */
  readonly taken: readonly string[]
  readonly onMade: (id: string) => void
}

export function NewSweep({ taken, onMade }: NewSweepProps) {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <Button size="compact-sm" onClick={() => setOpen(true)} leftSection={<IconPlus size={14} aria-hidden />}>
        New sweep
      </Button>
      <Dialog isOpen={isOpen} title="New sweep" onClose={() => setOpen(false)}>
        <NewSweepForm
          taken={taken}
          onMade={(id) => {
            setOpen(false)
            onMade(id)
          }}
        />
      </Dialog>
    </>
  )
}

export function NewSweepForm({ taken, onMade }: NewSweepProps) {
  const [draft, setDraft] = useState<SweepDraft>({ id: '', behavior: '', runs: '100', required: '', factors: [], search: undefined })
  const [refusal, setProblem] = useState('')
  const [step, setStep] = useState<'' | 'Checking …' | 'Starting …'>('')
  const isSending = step !== ''
  const { value: behaviors = [], problem: noBehaviors } = useAnswer(behaviorQueries.all())
  const { value: choices = [], problem: noChoices } = useAnswer({ ...sweepQueries.factors(draft.behavior), enabled: draft.behavior !== '' })
  const problem = refusal || noBehaviors || noChoices
  const id = draft.id || (draft.behavior ? proposedId(draft.behavior, taken) : '')

  function change(changed: Partial<SweepDraft>): void {
    setDraft((before) => ({ ...before, ...changed }))
    setProblem('')
  }

  function withFactor(at: number, factor: FactorDraft | undefined): void {
    change({ factors: draft.factors.flatMap((each, index) => (index === at ? (factor ? [factor] : []) : [each])) })
  }

  async function send(isStarted: boolean): Promise<void> {
    const document = documentOf(draft)
    if (typeof document === 'string') {
      setProblem(document)
      return
    }
    setStep('Checking …')
    try {
      await sweepsApi.create({ id, document })
      if (isStarted) {
        setStep('Starting …')
        await sweepsApi.start(id)
      }
      onMade(id)
    } catch (error) {
      setProblem(wordsOf(error))
    }
    setStep('')
  }

  return (
    <form
      onSubmit={(event) => {
        event.preventDefault()
        if (!isSending) void send(true)
      }}
    >
      <Stack gap="sm" miw="min(24rem, 80vw)">
        <NativeSelect
          label="Behavior"
          value={draft.behavior}
          onChange={(event) => change({ behavior: event.currentTarget.value, factors: [] })}
        >
          <option value="">Choose one</option>
          {behaviors.map((each) => (
            <option key={each.id} value={each.id} disabled={each.errors > 0}>
              {each.id.replace(/^behaviors\//, '')}
            </option>
          ))}
        </NativeSelect>
        <NativeSelect
          label="To find out"
          value={draft.search ? 'search' : 'rate'}
          onChange={(event) => change({ search: event.currentTarget.value === 'search' ? NEW_SEARCH : undefined })}
        >
          <option value="rate">how often it succeeds: random runs</option>
          <option value="search">how it fails: a search for failures</option>
        </NativeSelect>
        <Group gap="xs">
          <TextInput
            flex="1 1 8rem"
            label="Runs"
            inputMode="numeric"
            value={draft.runs}
            onChange={(event) => change({ runs: event.currentTarget.value })}
          />
          {!draft.search && (
            <TextInput
              flex="1 1 8rem"
              label="Required success rate, %"
              inputMode="decimal"
              placeholder="none"
              value={draft.required}
              onChange={(event) => change({ required: event.currentTarget.value })}
            />
          )}
        </Group>
        {draft.search && <SearchFields search={draft.search} onChange={(search) => change({ search })} />}
        <Fieldset
          variant="unstyled"
          legend={
            <Text span fz="sm" fw={600}>
              What is varied
            </Text>
          }
        >
          {draft.factors.map((factor, at) => (
            <FactorFields
              key={at}
              factor={factor}
              number={at + 1}
              choices={choices}
              onChange={(changed) => withFactor(at, changed)}
              onRemove={() => withFactor(at, undefined)}
            />
          ))}
          <Button
            size="compact-sm"
            variant="default"
            mt="2xs"
            aria-disabled={!draft.behavior || undefined}
            data-disabled={!draft.behavior}
            onClick={() => draft.behavior && change({ factors: [...draft.factors, NO_FACTOR] })}
            leftSection={<IconPlus size={14} aria-hidden />}
          >
            Add a factor
          </Button>
          <Note isQuiet>Each run has a seed of its own, and places the parts that have jitter.</Note>
        </Fieldset>
        <TextInput
          label="Document in the project"
          styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
          placeholder={id || 'behaviors/sweeps/name.yaml'}
          value={draft.id}
          onChange={(event) => change({ id: event.currentTarget.value })}
        />
        <Refusal>{problem}</Refusal>
        <Group gap="xs">
          <Button size="xs" type="submit" aria-disabled={isSending || undefined} data-disabled={isSending}>
            {step || 'Create and start'}
          </Button>
          <Button
            size="xs"
            variant="default"
            aria-disabled={isSending || undefined}
            data-disabled={isSending}
            onClick={() => !isSending && void send(false)}
          >
            Make only
          </Button>
        </Group>
      </Stack>
    </form>
  )
}
