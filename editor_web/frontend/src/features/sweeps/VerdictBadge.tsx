/** Whether what a sweep requires is reached: word, shape and colour. */
import type { SweepLive } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { percent, requiredRate, verdictWords } from '../../document/sweeps'

export function VerdictBadge({ live, require }: { readonly live: SweepLive; readonly require: string }) {
  const words = verdictWords(live.verdict)
  const required = requiredRate(require)
  if (!words || required === undefined) return null
  const [status, word] = live.done > 0 ? words : (['idle', 'Required'] as const)
  return (
    <span className={`badge is-${status}`} title={require}>
      <StatusIcon status={status} size={13} />
      {word}: at least {percent(required)}
    </span>
  )
}
