/** How far the goal of a node is: a bar where its feedback tells a share, and its words. */
import { lookup } from '../document/dict'
import './goalLine.css'
import { useGoals } from '../api/goals'
import { useLive } from '../api/live'

export function GoalLine({ path }: { path: string }) {
  const goal = useGoals((s) => lookup(s.goals, path))
  // What is under way now is no part of a moment of the past.
  const isNow = useLive((s) => s.past === undefined)
  if (!goal || !isNow) return null
  const percent = goal.share === null ? undefined : Math.round(goal.share * 100)
  const words = [percent !== undefined && `${percent} %`, goal.words].filter(Boolean).join(', ') || goal.address
  return (
    <span className="goal-line" title={`${goal.address} ${goal.status}`}>
      <span className="goal-words">{words}</span>
      {percent !== undefined && (
        <span
          className="goal-bar"
          role="progressbar"
          aria-label={`Progress of ${goal.address}`}
          aria-valuenow={percent}
          aria-valuemin={0}
          aria-valuemax={100}
        >
          <span style={{ width: `${percent}%` }} />
        </span>
      )}
    </span>
  )
}
