/** A sweep compared with another version that has executed the same runs: is this one worse? */
import { useState } from 'react'
import { wordsOf } from '../../api/client'
import { sweepsApi } from '../../api/sweeps'
import type { Baseline, SweepComparison } from '../../api/types'
import { baselineName, marginOf } from '../../document/baselines'
import { ComparedRates } from './ComparedRates'

export interface BaselineChoiceProps {
  readonly sweep: string
  /** Another one makes what was compared old. */
  readonly revision: number
  readonly onSelect: (run: number) => void
}

interface Compared {
  readonly revision: number
  readonly comparison: SweepComparison
}

export function BaselineChoice({ sweep, revision, onSelect }: BaselineChoiceProps) {
  const [known, setKnown] = useState<readonly Baseline[]>()
  const [at, setAt] = useState(0)
  const [margin, setMargin] = useState('')
  const [compared, setCompared] = useState<Compared>()
  const [problem, setProblem] = useState('')
  const [isAsking, setAsking] = useState(false)
  const comparison = compared?.revision === revision ? compared.comparison : undefined

  async function ask(asked: () => Promise<void>): Promise<void> {
    setAsking(true)
    setProblem('')
    try {
      await asked()
    } catch (error) {
      setProblem(wordsOf(error))
    }
    setAsking(false)
  }

  async function compare(baseline: Baseline | undefined): Promise<void> {
    const required = marginOf(margin)
    if (typeof required === 'string') throw new Error(required)
    if (baseline) setCompared({ revision, comparison: await sweepsApi.comparison(sweep, baseline, required) })
  }

  async function find(): Promise<void> {
    const found = await sweepsApi.baselines(sweep)
    setKnown(found)
    setAt(0)
    await compare(found[0])
  }

  return (
    <>
      {known === undefined && (
        <>
          <p className="quiet sweep-note">
            Is this version worse than one before? Both have executed the same runs; only those that ended differently count.
          </p>
          <button type="button" className="command" aria-disabled={isAsking || undefined} onClick={() => !isAsking && void ask(find)}>
            {isAsking ? 'Looking …' : 'Choose a baseline'}
          </button>
        </>
      )}
      {known?.length === 0 && (
        <p className="quiet sweep-note">
          No other version has executed these runs. After a change of the behavior, its cell or a package, execute the sweep again, and
          compare it with what it was.
        </p>
      )}
      {known !== undefined && known.length > 0 && (
        <form
          className="sweep-baseline"
          onSubmit={(event) => {
            event.preventDefault()
            if (!isAsking) void ask(() => compare(known[at]))
          }}
        >
          <label>
            Baseline
            <select
              className="new-input"
              value={at}
              onChange={(event) => {
                const chosen = Number(event.currentTarget.value)
                setAt(chosen)
                void ask(() => compare(known[chosen]))
              }}
            >
              {known.map((each, index) => (
                <option key={`${each.results} ${each.version.version}`} value={index}>
                  {baselineName(each)}
                </option>
              ))}
            </select>
          </label>
          <label>
            May be lower by, points
            <input
              className="new-input"
              inputMode="decimal"
              placeholder="not required"
              value={margin}
              onChange={(event) => setMargin(event.currentTarget.value)}
            />
          </label>
          <button type="submit" className="command" aria-disabled={isAsking || undefined}>
            Compare
          </button>
        </form>
      )}
      {problem && (
        <p className="is-failed" role="alert">
          {problem}
        </p>
      )}
      {comparison && <ComparedRates compared={comparison} onSelect={onSelect} />}
    </>
  )
}
