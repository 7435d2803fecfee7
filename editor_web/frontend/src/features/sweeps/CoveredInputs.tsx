/** What the runs have covered of the factors, one by one and in pairs: nothing is known of the rest. */
import { List, Text } from '@mantine/core'
import type { InputCoverage } from '../../api/types'
import { coverageText } from '../../document/sweeps'
import { Mono, PartTitle } from './Note'

const PAIRS = 6

export function CoveredInputs({ inputs }: { readonly inputs: InputCoverage }) {
  if (inputs.factors.length === 0) return null
  return (
    <>
      <PartTitle>Inputs</PartTitle>
      <List
        listStyleType="none"
        fz="0.8rem"
        mah="15rem"
        style={{ overflow: 'auto', overflowWrap: 'anywhere' }}
        aria-label="Covered inputs"
        tabIndex={0}
      >
        {inputs.factors.map((factor) => (
          <li key={factor.address}>
            <Mono>{factor.address}</Mono>{' '}
            <Text span inherit c="dimmed">
              {coverageText(factor)}
            </Text>
          </li>
        ))}
        {inputs.pairs.slice(0, PAIRS).map(({ first, second, parts, covered }) => (
          <li key={`${first} ${second}`}>
            <Mono>{first}</Mono>{' '}
            <Text span inherit c="dimmed">
              with {second}: {covered} of {parts} pairs of parts have a run
            </Text>
          </li>
        ))}
      </List>
    </>
  )
}
