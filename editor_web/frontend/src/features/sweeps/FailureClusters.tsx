/** Failures by cause, and for each cause the ranges of the factors with which runs failed so. */
import type { FailureCluster, FactorRegion } from '../../api/types'
import { percent } from '../../document/sweeps'
import { rangeText } from '../../document/searches'
import { CauseButton } from './Outcomes'

const HEAD = ['Failing', 'Executed', 'Likelihood', 'Successes in there']

export interface FailureClustersProps {
  readonly clusters: readonly FailureCluster[]
  /** An example of the cause whose runs are listed. */
  readonly chosen: number | undefined
  readonly onChoose: (example: number | undefined) => void
}

export function FailureClusters({ clusters, chosen, onChoose }: FailureClustersProps) {
  return (
    <ul className="plain-list sweep-clusters" aria-label="Causes of failures">
      {clusters.map(({ cause, regions }) => (
        <li key={`${cause.at} ${cause.message}`}>
          <CauseButton cause={cause} chosen={chosen} onChoose={onChoose} />
          {regions.length > 0 && <Regions regions={regions} cause={cause.message} />}
        </li>
      ))}
    </ul>
  )
}

function Regions({ regions, cause }: { readonly regions: readonly FactorRegion[]; readonly cause: string }) {
  return (
    <div className="sweep-scroll" tabIndex={0} role="group" aria-label={`Where it fails: ${cause}`}>
      <table className="sweep-table">
        <thead>
          <tr>
            <th scope="col">Factor</th>
            {HEAD.map((name) => (
              <th key={name} scope="col" className="is-number">
                {name}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {regions.map((region) => (
            <tr key={region.address}>
              <th scope="row" className="mono sweep-path" title={region.address}>
                <bdi>{region.address}</bdi>
              </th>
              <td className="is-number">{rangeText(region.failing, region.listed)}</td>
              <td className="is-number">{rangeText(region.executed, region.listed)}</td>
              <td className="is-number">{percent(region.share)}</td>
              <td className="is-number">{region.passed_inside}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  )
}
