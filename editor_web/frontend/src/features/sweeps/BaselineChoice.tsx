/** A sweep compared with another version that has executed the same runs: is this one worse? */
import { Button, Group, NativeSelect, TextInput } from '@mantine/core'
import { useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { wordsOf } from '../../api/client'
import { sweepsApi } from '../../api/sweeps'
import type { Baseline, SweepComparison } from '../../api/types'
import { baselineName, marginOf } from '../../document/baselines'
import { ComparedRates } from './ComparedRates'
import { Note } from './Note'

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
          <Note isQuiet>
            Is this version worse than one before? Both have executed the same runs; only those that ended differently count.
          </Note>
          <Button
            size="compact-sm"
            variant="default"
            aria-disabled={isAsking || undefined}
            data-disabled={isAsking}
            onClick={() => !isAsking && void ask(find)}
          >
            {isAsking ? 'Looking …' : 'Choose a baseline'}
          </Button>
        </>
      )}
      {known?.length === 0 && (
        <Note isQuiet>
          No other version has executed these runs. After a change of the behavior, its cell or a package, execute the sweep again, and
          compare it with what it was.
        </Note>
      )}
      {known !== undefined && known.length > 0 && (
        <form
          onSubmit={(event) => {
            event.preventDefault()
            if (!isAsking) void ask(() => compare(known[at]))
          }}
        >
          <Group gap="xs" align="end" mb="2xs">
            <NativeSelect
              size="xs"
              flex="1 1 100%"
              label="Baseline"
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
            </NativeSelect>
            <TextInput
              size="xs"
              flex={1}
              label="May be lower by, points"
              inputMode="decimal"
              placeholder="not required"
              value={margin}
              onChange={(event) => setMargin(event.currentTarget.value)}
            />
            <Button size="xs" variant="default" type="submit" aria-disabled={isAsking || undefined} data-disabled={isAsking}>
              Compare
            </Button>
          </Group>
        </form>
      )}
      <Refusal>{problem}</Refusal>
      {comparison && <ComparedRates compared={comparison} onSelect={onSelect} />}
    </>
  )
}
