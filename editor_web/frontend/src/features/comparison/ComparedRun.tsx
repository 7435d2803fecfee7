/** One of the two runs: which it is, how it ended, and the way to its page. */
import type { PastRun } from '../../api/types'
import { PageLink } from '../../components/PageLink'
import { RunBadge } from '../../components/StatusBadge'
import type { Side } from '../../document/comparison'
import { duration, wallTime } from '../../document/time'
import styles from './comparison.module.css'

interface ComparedRunProps {
  readonly side: Side
  readonly run: PastRun
  readonly href: string
  readonly onOpen: () => void
}

export function ComparedRun({ side, run, href, onOpen }: ComparedRunProps) {
  return (
    <section className={styles.run} aria-label={`Run on the ${side}`}>
      <span className={styles.side}>{side === 'left' ? 'Left' : 'Right'}</span>
      <PageLink href={href} onOpen={onOpen}>
        {run.behavior}
      </PageLink>
      <RunBadge run={run.status === 'running' ? { status: 'interrupted' } : run} />
      <span className="quiet">
        {wallTime(run.started_at_s)}, {duration(run.duration_s)}
      </span>
      {run.cause && (
        <span className={styles.cause} title={run.cause}>
          {run.cause}
        </span>
      )}
    </section>
  )
}
