/** Making a sweep: what is executed, how often, what is varied and what is required; it becomes a document. */
import { IconPlus } from '@tabler/icons-react'
import { useState } from 'react'
import { behaviorQueries } from '../../api/behaviorQueries'
import { wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { sweepQueries, sweepsApi } from '../../api/sweeps'
import { Dialog } from '../../components/Dialog'
import { documentOf, proposedId, type FactorDraft, type SweepDraft } from '../../document/sweeps'
import { FactorFields, NO_FACTOR } from './FactorFields'
import { NEW_SEARCH, SearchFields } from './SearchFields'

export interface NewSweepProps {
  /** The sweeps that there are. */
  readonly taken: readonly string[]
  readonly onMade: (id: string) => void
}

export function NewSweep({ taken, onMade }: NewSweepProps) {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <button type="button" className="command is-strong" onClick={() => setOpen(true)}>
        <IconPlus size={14} aria-hidden /> New sweep
      </button>
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
      className="new-form sweep-form"
      onSubmit={(event) => {
        event.preventDefault()
        if (!isSending) void send(true)
      }}
    >
      <label>
        Behavior
        <select
          className="new-input"
          value={draft.behavior}
          onChange={(event) => change({ behavior: event.currentTarget.value, factors: [] })}
        >
          <option value="">Choose one</option>
          {behaviors.map((each) => (
            <option key={each.id} value={each.id} disabled={each.errors > 0}>
              {each.id.replace(/^behaviors\//, '')}
            </option>
          ))}
        </select>
      </label>
      <label>
        To find out
        <select
          className="new-input"
          value={draft.search ? 'search' : 'rate'}
          onChange={(event) => change({ search: event.currentTarget.value === 'search' ? NEW_SEARCH : undefined })}
        >
          <option value="rate">how often it succeeds: random runs</option>
          <option value="search">how it fails: a search for failures</option>
        </select>
      </label>
      <div className="sweep-form-row">
        <label>
          Runs
          <input
            className="new-input"
            inputMode="numeric"
            value={draft.runs}
            onChange={(event) => change({ runs: event.currentTarget.value })}
          />
        </label>
        {!draft.search && (
          <label>
            Required success rate, %
            <input
              className="new-input"
              inputMode="decimal"
              placeholder="none"
              value={draft.required}
              onChange={(event) => change({ required: event.currentTarget.value })}
            />
          </label>
        )}
      </div>
      {draft.search && <SearchFields search={draft.search} onChange={(search) => change({ search })} />}
      <fieldset className="sweep-factors">
        <legend>What is varied</legend>
        {draft.factors.map((factor, at) => (
          <FactorFields
            key={at}
            factor={factor}
            choices={choices}
            onChange={(changed) => withFactor(at, changed)}
            onRemove={() => withFactor(at, undefined)}
          />
        ))}
        <button
          type="button"
          className="command"
          aria-disabled={!draft.behavior || undefined}
          onClick={() => draft.behavior && change({ factors: [...draft.factors, NO_FACTOR] })}
        >
          <IconPlus size={14} aria-hidden /> Add a factor
        </button>
        <p className="quiet sweep-note">Each run has a seed of its own, and places the parts that have jitter.</p>
      </fieldset>
      <label>
        Document in the project
        <input
          className="new-input mono"
          placeholder={id || 'behaviors/sweeps/name.yaml'}
          value={draft.id}
          onChange={(event) => change({ id: event.currentTarget.value })}
        />
      </label>
      {problem && (
        <p className="is-failed" role="alert">
          {problem}
        </p>
      )}
      <div className="sweep-form-row">
        <button type="submit" className="command is-strong" aria-disabled={isSending || undefined}>
          {step || 'Make and start'}
        </button>
        <button type="button" className="command" aria-disabled={isSending || undefined} onClick={() => !isSending && void send(false)}>
          Make only
        </button>
      </div>
    </form>
  )
}
