/** Says over the 3D view that it shows the past, or why it does not. */
import { IconHistory } from '@tabler/icons-react'
import { usePast } from '../../api/past'
import { duration } from '../../document/time'

// A recording has messages so often; what is later than its end by more was not recorded.
const SLACK_S = 0.5

export function PastMark() {
  const { requested, shown } = usePast()
  if (requested === null || shown === null) return null
  const { run, time_s, until_s, problem } = shown
  const isAfter = time_s > until_s + SLACK_S
  return (
    <div className="cell-past" title={run}>
      <IconHistory size={15} aria-hidden />
      {problem ? (
        <span>Live: {problem}</span>
      ) : (
        <span>{isAfter ? `Recorded until ${duration(until_s)}` : duration(Math.max(0, time_s))}</span>
      )}
      {!problem && <span className="cell-past-run">of {run}</span>}
    </div>
  )
}
