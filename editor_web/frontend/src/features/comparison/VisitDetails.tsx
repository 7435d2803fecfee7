/** One aligned visit: when it was in each run, why it ended so, and the values that it read and wrote. */
import type { AlignedVisit, DataDifference, Visit } from '../../api/types'
import { PageLink } from '../../components/PageLink'
import { endWords, type Side } from '../../document/comparison'
import { duration } from '../../document/time'
import { DifferenceTable } from './DifferenceTable'
import styles from './comparison.module.css'

interface VisitDetailsProps {
  readonly visit: AlignedVisit
  readonly data: readonly DataDifference[]
  /** The page of a run at a time of it, with the node selected. */
  readonly href: (side: Side, timeS: number, path: string) => string
  readonly onOpen: (href: string) => void
}

export function VisitDetails({ visit, data, href, onOpen }: VisitDetailsProps) {
  return (
    <div className={styles.details}>
      <h3>{visit.path}</h3>
      <OfRun side="left" visit={visit.left} href={href} onOpen={onOpen} />
      <OfRun side="right" visit={visit.right} href={href} onOpen={onOpen} />
      <h3>Values that differ</h3>
      {data.length === 0 ? (
        <p className="quiet">It read and wrote the same values.</p>
      ) : (
        <DifferenceTable rows={data.map((each) => ({ ...each, at: `${each.kind} ${each.at}` }))} name="Value" />
      )}
    </div>
  )
}

interface OfRunProps extends Pick<VisitDetailsProps, 'href' | 'onOpen'> {
  readonly side: Side
  readonly visit: Visit | null
}

function OfRun({ side, visit, href, onOpen }: OfRunProps) {
  const name = side === 'left' ? 'Left' : 'Right'
  if (!visit) {
    return (
      <p>
        <span className={styles.side}>{name}</span> not entered
      </p>
    )
  }
  const target = href(side, visit.end_s ?? visit.start_s, visit.path)
  return (
    <div className={styles.ofRun}>
      <span className={styles.side}>{name}</span> {endWords(visit)}, from {duration(visit.start_s)}{' '}
      {visit.end_s !== null && `to ${duration(visit.end_s)} `}
      <PageLink href={target} onOpen={() => onOpen(target)}>
        Open the {side} run there
      </PageLink>
      {visit.cause && <p className={styles.reason}>{visit.cause}</p>}
    </div>
  )
}
