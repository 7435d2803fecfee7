/** How runs ended with the interval of each share, and why they failed: a cause shows its runs. */
import type { CauseGroup, OutcomeShare } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { intervalText, percent } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'

export function OutcomeTable({ outcomes, done }: { readonly outcomes: readonly OutcomeShare[]; readonly done: number }) {
  return (
    <div className="sweep-scroll" tabIndex={0} role="group" aria-label="Table of outcomes">
      <table className="sweep-table">
        <thead>
          <tr>
            <th scope="col">Outcome</th>
            <th scope="col" className="is-number">
              Runs
            </th>
            <th scope="col" className="is-number">
              Share
            </th>
            <th scope="col">Interval</th>
            <td />
          </tr>
        </thead>
        <tbody>
          {outcomes.map((each) => (
            <tr key={each.label}>
              <th scope="row">
                <span className="sweep-outcome">
                  <StatusIcon status={each.success ? 'done' : 'failed'} size={14} />
                  <span className="visually-hidden">{each.success ? 'success: ' : 'no success: '}</span>
                  {each.label}
                </span>
              </th>
              <td className="is-number">{each.runs}</td>
              <td className="is-number">{percent(each.runs / done)}</td>
              <td className="is-interval">{intervalText(each.interval)}</td>
              <td className="sweep-bar-cell">
                <IntervalBar interval={each.interval} rate={each.runs / done} isBad={!each.success} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  )
}

export interface CauseListProps {
  readonly causes: readonly CauseGroup[]
  /** An example of the cause whose runs are listed. */
  readonly chosen: number | undefined
  readonly onChoose: (example: number | undefined) => void
}

export function CauseList({ causes, chosen, onChoose }: CauseListProps) {
  return (
    <ul className="plain-list sweep-causes" aria-label="Causes of failures">
      {causes.map((each) => (
        <li key={`${each.at} ${each.message}`}>
          <CauseButton cause={each} chosen={chosen} onChoose={onChoose} />
        </li>
      ))}
    </ul>
  )
}

/** A cause, pressed where its runs are listed. */
export function CauseButton({ cause, chosen, onChoose }: { readonly cause: CauseGroup } & Pick<CauseListProps, 'chosen' | 'onChoose'>) {
  const example = cause.examples[0]
  const isChosen = chosen !== undefined && chosen === example
  return (
    <button type="button" className="sweep-cause" aria-pressed={isChosen} onClick={() => onChoose(isChosen ? undefined : example)}>
      <span className="sweep-cause-runs">
        {cause.runs} {cause.runs === 1 ? 'run' : 'runs'}
      </span>
      <span>
        {cause.message}
        {cause.at && <span className="quiet mono sweep-cause-at">{cause.at}</span>}
      </span>
    </button>
  )
}
