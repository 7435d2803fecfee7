/** The runs that succeeded and came nearest to failure, with the number that is searched for. */
import type { SearchView } from '../../api/types'
import { lookup } from '../../document/dict'
import { numberOf, short } from '../../document/sweeps'

export function NearestRuns({ view, onSelect }: { readonly view: SearchView; readonly onSelect: (run: number) => void }) {
  const factors = Object.keys(view.nearest[0]?.configuration.values ?? {}).filter((address) => address !== 'seed')
  return (
    <div className="sweep-scroll" tabIndex={0} role="group" aria-label="Table of the nearest successes">
      <table className="sweep-table">
        <thead>
          <tr>
            <th scope="col">Run</th>
            {[view.towards, ...factors].map((name) => (
              <th key={name} scope="col" className="is-number">
                {name}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {view.nearest.map((run) => (
            <tr key={run.configuration.number}>
              <th scope="row">
                <button type="button" className="link" onClick={() => onSelect(run.configuration.number)}>
                  #{run.configuration.number}
                </button>
              </th>
              <td className="is-number">{short(numberOf(run, view.target.name))}</td>
              {factors.map((address) => (
                <td key={address} className="is-number">
                  {short(lookup(run.configuration.values, address))}
                </td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  )
}
