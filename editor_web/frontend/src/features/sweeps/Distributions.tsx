/** The distributions of numbers over runs: quantiles, and the same as a strip. */
import { useState } from 'react'
import type { Quantiles, SweepView } from '../../api/types'
import { quantileGroups, short, type QuantileGroup } from '../../document/sweeps'

const FIRST = 8

export function Distributions({ view }: { readonly view: SweepView }) {
  return quantileGroups(view).map((group) => <Group key={group.key} group={group} />)
}

function Group({ group }: { readonly group: QuantileGroup }) {
  const [isWhole, setWhole] = useState(false)
  const rows = isWhole ? group.rows : group.rows.slice(0, FIRST)
  const rest = group.rows.length - rows.length
  // Seconds of nodes are compared with one another; other numbers have units of their own.
  const common = group.key === 'nodes' ? Math.max(...group.rows.map((row) => row.most)) : undefined
  return (
    <>
      <h3 className="sweep-subtitle">{group.title}</h3>
      <div className="sweep-scroll" tabIndex={0} role="group" aria-label={`Table: ${group.title}`}>
        <table className="sweep-table">
          <thead>
            <tr>
              <th scope="col">Of</th>
              {['Least', 'Middle', '95 %', 'Most'].map((name) => (
                <th key={name} scope="col" className="is-number">
                  {name}
                </th>
              ))}
              <td />
            </tr>
          </thead>
          <tbody>
            {rows.map((row) => (
              <tr key={row.name}>
                <th scope="row" className="mono sweep-path" title={`${row.name}, ${row.runs} runs`}>
                  {row.name}
                </th>
                {[row.least, row.middle, row.p95, row.most].map((value, at) => (
                  <td key={at} className="is-number">
                    {short(value)}
                  </td>
                ))}
                <td className="sweep-bar-cell">
                  <Strip row={row} from={common === undefined ? row.least : 0} to={common ?? row.most} />
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      {rest > 0 && (
        <button type="button" className="link" onClick={() => setWhole(true)}>
          Show {rest} more
        </button>
      )}
    </>
  )
}

function Strip({ row, from, to }: { readonly row: Quantiles; readonly from: number; readonly to: number }) {
  const at = (value: number) => `${(100 * (value - from)) / (to - from || 1)}%`
  const width = (low: number, high: number) => `${(100 * (high - low)) / (to - from || 1)}%`
  return (
    <span className="sweep-bar is-plain" aria-hidden>
      <span className="sweep-whisker" style={{ left: at(row.least), width: width(row.least, row.most) }} />
      <span className="sweep-box" style={{ left: at(row.middle), width: width(row.middle, row.p95) }} />
      <span className="sweep-dot" style={{ left: at(row.middle) }} />
    </span>
  )
}
