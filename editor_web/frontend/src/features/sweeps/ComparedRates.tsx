/** Both success rates, their difference with its interval, the verdict, and the runs that are broken. */
import type { SweepComparison } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { differenceScale, pointsIntervalText, pointsText, ratesOf, shareText } from '../../document/baselines'
import { verdictWords } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'

export function ComparedRates({
  compared: { comparison, verdict, words },
  onSelect,
}: {
  readonly compared: SweepComparison
  readonly onSelect: (run: number) => void
}) {
  const { pair, interval, margin, broken, changed } = comparison
  const rates = ratesOf(pair)
  const runs = rates[0]?.runs ?? 0
  const difference = (pair.only_second - pair.only_first) / runs
  const place = differenceScale(interval, margin)
  const badge = verdictWords(verdict)
  return (
    <>
      <div className="sweep-scroll" tabIndex={0} role="group" aria-label="Table of both versions">
        <table className="sweep-table">
          <thead className="visually-hidden">
            <tr>
              <th scope="col">Version</th>
              <th scope="col">Succeeded</th>
              <th scope="col">Rate</th>
              <td />
            </tr>
          </thead>
          <tbody>
            {rates.map((each) => (
              <tr key={each.name}>
                <th scope="row">{each.name}</th>
                <td className="is-number">
                  {each.successes} of {each.runs}
                </td>
                <td className="is-number">{shareText(each.successes, each.runs)}</td>
                <td className="sweep-bar-cell" />
              </tr>
            ))}
            <tr>
              <th scope="row">Difference</th>
              <td className="is-number">{pointsIntervalText(interval)}</td>
              <td className="is-number">{pointsText(difference)}</td>
              <td className="sweep-bar-cell">
                <span className="sweep-difference" aria-hidden>
                  <span className="sweep-no-difference" />
                  {margin !== null && <span className="sweep-margin" style={{ left: `${100 * place(-margin)}%` }} />}
                  <IntervalBar interval={[place(interval[0]), place(interval[1])]} rate={place(difference)} isBad={interval[1] < 0} />
                </span>
              </td>
            </tr>
          </tbody>
        </table>
      </div>
      <p className="sweep-note">
        {badge && (
          <span className={`badge is-${badge[0]}`}>
            <StatusIcon status={badge[0]} size={13} />
            {badge[1]}
          </span>
        )}{' '}
        This version is {words}.
      </p>
      {broken.length > 0 && (
        <p className="sweep-note">
          Broken:{' '}
          {broken.map((run) => (
            <button key={run} type="button" className="link sweep-broken" aria-label={`Run ${run}`} onClick={() => onSelect(run)}>
              #{run}
            </button>
          ))}
          {pair.only_first > broken.length && `and ${pair.only_first - broken.length} more`}
        </p>
      )}
      {changed.length > 0 && <p className="quiet sweep-note">Different: {changed.join(', ')}.</p>}
    </>
  )
}
