/** From demonstration to behavior: choose entries in their order, see what it will do, make it. */
import './demonstration.css'
import { IconAlertTriangle } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { propose } from '../../api/demonstration'
import { documents } from '../../api/documents'
import type { EntryName, ProposalBody, ProposalOptions } from '../../api/types'
import { added, bodyOf, type Step } from '../../document/demonstration'
import { fileProblem, idOfFile } from '../../document/editing/fileNames'
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
    <div className="demonstration">
      <div className="demonstration-columns">
        <EntryChoice entries={entries} onAdd={(kind, name) => setSteps(added(steps, kind, name))} />
        <StepList steps={steps} decided={proposed.proposal?.steps ?? []} parts={proposed.proposal?.parts ?? []} onChange={setSteps} />
        <div className="proposal">
          <OptionFields options={options} arms={proposed.proposal?.arms ?? []} arm={proposed.proposal?.arm} onChange={setOptions} />
          <Preview proposed={proposed} />
        </div>
      </div>
      <MakeForm canMake={proposed.proposal !== undefined} refusal={refusal} onMake={make} />
    </div>
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
    <div className="proposal-options">
      <label>
        Arm
        <select value={options.arm || arm || ''} onChange={(event) => onChange({ ...options, arm: event.currentTarget.value })}>
          {!(options.arm || arm) && <option value="">by the names</option>}
          {[...new Set([...arms, ...(options.arm ? [options.arm] : [])])].map((name) => (
            <option key={name} value={name}>
              {name}
            </option>
          ))}
        </select>
      </label>
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
    </div>
  )
}

/** What the behavior will do, in words. */
function Preview({ proposed }: { proposed: Proposed }) {
  const { proposal, problem } = proposed
  return (
    <section className="preview" aria-label="Resulting steps" aria-live="polite">
      <h3>Resulting steps</h3>
      {problem && (
        <p className="is-failed" role="alert">
          {problem}
        </p>
      )}
      {!proposal && !problem && <p className="quiet">Shown here as soon as there is a step.</p>}
      {proposal && (
        <>
          <ol className="preview-words">
            {proposal.words.map((words, index) => (
              <li key={index}>{words}</li>
            ))}
          </ol>
          {warnings(proposal).map((words) => (
            <p key={words} className="preview-remark">
              <IconAlertTriangle size={15} aria-hidden /> <span>{words}</span>
            </p>
          ))}
        </>
      )}
    </section>
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
  const id = idOfFile('', name.trim().replace(/[^A-Za-z0-9_-]+/g, '_') || 'name', '.yaml')
  const obstacle = canMake ? fileProblem('', name) : 'There is nothing to be done yet'
  const problem = isTried ? (obstacle ?? refusal) : refusal
  return (
    <form
      className="demonstration-make"
      onSubmit={(event) => {
        event.preventDefault()
        setTried(true)
        if (!obstacle) onMake(id)
      }}
    >
      <label>
        Name
        <input value={name} placeholder="taught_transfer" onChange={(event) => setName(event.currentTarget.value)} />
      </label>
      <span className="quiet mono demonstration-id">{id}</span>
      {problem && (
        <span className="is-failed" role="alert">
          {problem}
        </span>
      )}
      <button type="submit" className="command is-strong">
        Create and open
      </button>
    </form>
  )
}
