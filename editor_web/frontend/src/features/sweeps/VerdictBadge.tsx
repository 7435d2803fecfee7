/** Whether what a sweep requires is reached: word, shape and colour. */
import type { SweepLive } from '../../api/types'
import { StatusBadge } from '../../components/StatusBadge'
import { requiredText, verdictWords } from '../../document/sweeps'

export function VerdictBadge({ live, require }: { readonly live: SweepLive; readonly require: string }) {
  const words = verdictWords(live.verdict)
  if (!words || require === '') return null
  const [status, word] = live.done > 0 ? words : (['idle', 'Required'] as const)
  return (
    <span title={require}>
      <StatusBadge look={status} words={`${word}: ${requiredText(require)}`} />
    </span>
  )
}
