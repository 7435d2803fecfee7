/** One factor in a form: what is varied, and over which values. */
import { CloseButton, Group, NativeSelect, Stack, TextInput } from '@mantine/core'
import { useId } from 'react'
import type { FactorChoice } from '../../api/types'
import { proposedFactor, short, type FactorDraft } from '../../document/sweeps'
import { Note } from './Note'

export const NO_FACTOR: FactorDraft = { address: '', kind: 'uniform', first: '', second: '', values: '' }
const KINDS = [
  ['uniform', 'uniform'],
  ['log_uniform', 'log-uniform'],
  ['normal', 'normal'],
  ['values', 'values'],
] as const

export interface FactorFieldsProps {
  readonly factor: FactorDraft
  /** Which one it is, from 1 on. */
  readonly number: number
  readonly choices: readonly FactorChoice[]
  readonly onChange: (factor: FactorDraft) => void
  readonly onRemove: () => void
}

export function FactorFields({ factor, number, choices, onChange, onRemove }: FactorFieldsProps) {
  const list = useId()
  const choice = choices.find((each) => each.address === factor.address)
  const name = factor.address || `factor ${number}`
  const isNormal = factor.kind === 'normal'

  function choose(address: string): void {
    const found = choices.find((each) => each.address === address)
    onChange(found ? proposedFactor(found) : { ...factor, address })
  }

  return (
    <Stack gap="3xs" py="2xs" style={{ borderBottom: '1px solid var(--line)' }} role="group" aria-label={`Factor ${number}`}>
      <TextInput
        size="xs"
        styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
        list={list}
        aria-label="What is varied"
        placeholder="parameters.…, displace.…, cell.…"
        value={factor.address}
        onChange={(event) => choose(event.currentTarget.value)}
      />
      <datalist id={list}>
        {choices.map((each) => (
          <option key={each.address} value={each.address}>
            {`${short(each.nominal)} ${each.unit} ${each.description}`}
          </option>
        ))}
      </datalist>
      <Group gap="3xs" wrap="nowrap">
        <NativeSelect
          size="xs"
          flex={1}
          miw="6.5rem"
          aria-label={`Distribution of ${name}`}
          value={factor.kind}
          onChange={(event) => onChange({ ...factor, kind: event.currentTarget.value as FactorDraft['kind'] })}
        >
          {KINDS.map(([value, words]) => (
            <option key={value} value={value}>
              {words}
            </option>
          ))}
        </NativeSelect>
        {factor.kind === 'values' ? (
          <TextInput
            size="xs"
            flex={2}
            aria-label={`Values of ${name}`}
            placeholder="0.3, 0.5, 1"
            value={factor.values}
            onChange={(event) => onChange({ ...factor, values: event.currentTarget.value })}
          />
        ) : (
          <>
            <TextInput
              size="xs"
              flex={1}
              inputMode="decimal"
              aria-label={`${isNormal ? 'Mean' : 'Least value'} of ${name}`}
              placeholder={isNormal ? 'mean' : 'from'}
              value={factor.first}
              onChange={(event) => onChange({ ...factor, first: event.currentTarget.value })}
            />
            <TextInput
              size="xs"
              flex={1}
              inputMode="decimal"
              aria-label={`${isNormal ? 'Standard deviation' : 'Greatest value'} of ${name}`}
              placeholder={isNormal ? 'deviation' : 'to'}
              value={factor.second}
              onChange={(event) => onChange({ ...factor, second: event.currentTarget.value })}
            />
          </>
        )}
        <CloseButton aria-label={`Remove ${name}`} onClick={onRemove} />
      </Group>
      {choice && (
        <Note isQuiet>
          {choice.nominal === null ? 'without a default' : `${short(choice.nominal)} ${choice.unit} where nothing is varied`}
          {choice.description && `; ${choice.description}`}
        </Note>
      )}
    </Stack>
  )
}
