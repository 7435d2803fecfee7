/** What the runs have covered of the factors, one by one and in pairs: nothing is known of the rest. */
import type { InputCoverage } from '../../api/types'
import { coverageText } from '../../document/sweeps'

const PAIRS = 6

export function CoveredInputs({ inputs }: { readonly inputs: InputCoverage }) {
  if (inputs.factors.length === 0) return null
  return (
    <>
      <h3 className="sweep-subtitle">Inputs</h3>
      <ul className="plain-list sweep-missing" aria-label="Covered inputs" tabIndex={0}>
        {inputs.factors.map((factor) => (
          <li key={factor.address}>
            <span className="mono">{factor.address}</span> <span className="quiet">{coverageText(factor)}</span>
          </li>
        ))}
        {inputs.pairs.slice(0, PAIRS).map(({ first, second, parts, covered }) => (
          <li key={`${first} ${second}`}>
            <span className="mono">{first}</span>{' '}
            <span className="quiet">
              with {second}: {covered} of {parts} pairs of parts have a run
            </span>
          </li>
        ))}
      </ul>
    </>
  )
}
