/** What a sweep requires of numbers of its runs, with the interval by which each requirement is judged. */
import type { JudgedRequirement } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { intervalText, keptText, verdictWords } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'

export function Requirements({ requirements }: { readonly requirements: readonly JudgedRequirement[] }) {
  // A success rate alone is told by the badge and the curve.
  if (requirements.every(({ number }) => number === null)) return null
  return (
    <div className="sweep-scroll" tabIndex={0} role="group" aria-label="What is required">
      <table className="sweep-table">
        <thead>
          <tr>
            <th scope="col">Required</th>
            <th scope="col">Runs that keep it</th>
            <th scope="col">Interval</th>
            <td />
          </tr>
        </thead>
        <tbody>
          {requirements.map((each) => (
            <tr key={each.text}>
              <th scope="row">
                <span className="sweep-outcome">
                  <Verdict verdict={each.verdict} />
                  {each.text}
                </span>
              </th>
              <td>{keptText(each)}</td>
              <td className="is-interval">{each.interval !== null && intervalText(each.interval)}</td>
              <td className="sweep-bar-cell">
                {each.interval !== null && each.runs > 0 && (
                  <IntervalBar interval={each.interval} rate={each.kept / each.runs} isBad={each.verdict === 'failed'} />
                )}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  )
}

function Verdict({ verdict }: { readonly verdict: JudgedRequirement['verdict'] }) {
  const words = verdictWords(verdict)
  if (!words) return null
  return (
    <>
      <StatusIcon status={words[0]} size={14} />
      <span className="visually-hidden">{words[1].toLowerCase()}: </span>
    </>
  )
}
