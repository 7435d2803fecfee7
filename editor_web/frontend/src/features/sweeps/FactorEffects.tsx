/** Which factor matters: success by level with intervals, and rank correlations; those that matter most first. */
import type { FactorEffect } from '../../api/types'
import { percent } from '../../document/sweeps'
import { IntervalBar } from './IntervalBar'

const FIRST = 8

export function FactorEffects({ effects }: { readonly effects: readonly FactorEffect[] }) {
  return effects.slice(0, FIRST).map((effect) => (
    <div key={effect.address} className="sweep-effect">
      <h3 className="sweep-subtitle mono">{effect.address}</h3>
      <p className="quiet sweep-note">{effectText(effect)}</p>
      <div className="sweep-scroll" tabIndex={0} role="group" aria-label={`Success by ${effect.address}`}>
        <table className="sweep-table">
          <thead className="visually-hidden">
            <tr>
              <th scope="col">Value</th>
              <th scope="col">Succeeded</th>
              <th scope="col">Rate</th>
              <td />
            </tr>
          </thead>
          <tbody>
            {effect.levels.map((level) => (
              <tr key={level.label}>
                <th scope="row">{level.label}</th>
                <td className="is-number">
                  {level.successes} of {level.runs}
                </td>
                <td className="is-number">{percent(level.successes / level.runs)}</td>
                <td className="sweep-bar-cell">
                  <IntervalBar interval={level.interval} rate={level.successes / level.runs} />
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </div>
  ))
}

function effectText(effect: FactorEffect): string {
  const parts = [
    ['success', effect.with_success],
    ['duration', effect.with_duration],
  ].flatMap(([name, value]) => (typeof value === 'number' ? [`correlation with ${name} ${signed(value)}`] : []))
  return parts.join('; ')
}

function signed(value: number): string {
  return `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`
}
