/** The changes of an entry, each with what it was then. */
import { IconEye } from '@tabler/icons-react'
import { useState } from 'react'
import { entryQueries } from '../../api/entries'
import { useAnswer } from '../../api/queryClient'
import { previewTaught } from '../../api/teaching'
import type { EntryChanged, EntryRecord } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { changesOf, degrees } from '../../document/teaching'
import { wallTime } from '../../document/time'
import { useFits } from './Comparison'
import { PLAYED } from './forms'
import { poseWords } from './poseWords'

const MOST_SHOWN = 1200

export function EntryHistory({ arm, entry }: { readonly arm: string; readonly entry: EntryChanged }) {
  const [opened, setOpened] = useState<number>()
  const { value } = useAnswer(entryQueries.history(entry.kind, entry.name))
  const history = value?.changes ?? []
  return (
    <>
      <h4>History</h4>
      <ol className="plain-list history" aria-label={`History of ${entry.name}`}>
        {history.toReversed().map((change) => {
          const words = `${change.deleted ? 'deleted' : change.revision === 1 ? 'made' : 'changed'}${change.by && ` by ${change.by}`}, ${wallTime(change.changed_unix_ms / 1000)}`
          return (
            <li key={change.revision}>
              {change.deleted ? (
                <span className="history-change">
                  <span className="mono">{change.revision}</span> {words}
                </span>
              ) : (
                <button
                  type="button"
                  className="history-change"
                  aria-expanded={opened === change.revision}
                  title="Value at that time"
                  onClick={() => setOpened(opened === change.revision ? undefined : change.revision)}
                >
                  <span className="mono">{change.revision}</span> {words}
                </button>
              )}
              {change.reason && <span className="quiet"> – {change.reason}</span>}
              {opened === change.revision && <Was arm={arm} entry={entry} revision={change.revision} />}
            </li>
          )
        })}
      </ol>
    </>
  )
}

interface WasProps {
  readonly arm: string
  readonly entry: EntryChanged
  readonly revision: number
}

function Was({ arm, entry, revision }: WasProps) {
  const { kind, name } = entry
  const hasPlace = PLAYED.has(kind)
  const { value: was, problem } = useAnswer(entryQueries.revision(kind, name, revision))
  const then = { kind, name, capture: 0, revision }
  const now = { ...then, revision: entry.revision }
  const { fits, problem: unfit } = useFits(
    hasPlace
      ? [
          { key: 'then', label: name, arm, what: then },
          { key: 'now', label: name, arm, what: now },
        ]
      : [],
  )
  const [before, after] = [fits.then, fits.now].map((fit) => fit?.demonstration ?? fit?.primitive ?? undefined)
  const joints = before?.joints.at(-1)
  const pose = before?.poses.at(-1)
  const isMotion = (before?.poses.length ?? 0) > 1
  return (
    <div className="was" role="group" aria-label={`Revision ${revision} of ${name}`}>
      <dl className="facts">
        {joints && (
          <>
            <dt>{isMotion ? 'Ends at joints' : 'Joints'}</dt>
            <dd className="mono">{joints.map((value) => `${degrees(value).toFixed(1)}°`).join('  ')}</dd>
          </>
        )}
        {pose && (
          <>
            <dt>{isMotion ? 'Ends at pose' : 'Pose'}</dt>
            <dd className="mono">{poseWords(pose)}</dd>
          </>
        )}
        {!hasPlace && was && (
          <>
            <dt>Value</dt>
            <dd className="mono">{valueWords(was)}</dd>
          </>
        )}
        {was?.tags && was.tags.length > 0 && (
          <>
            <dt>Tags</dt>
            <dd>{was.tags.join(', ')}</dd>
          </>
        )}
        {before && after && revision !== entry.revision && (
          <>
            <dt>Brought back</dt>
            <dd>{changesOf(after, before).join(', ')}</dd>
          </>
        )}
      </dl>
      {(problem || unfit) && (
        <p className="teach-problem" role="alert">
          {problem || unfit}
        </p>
      )}
      {hasPlace && (
        <CommandButton
          label="Show this one in the cell"
          icon={<IconEye size={15} aria-hidden />}
          onPress={() => previewTaught(arm, then)}
        />
      )}
    </div>
  )
}

function valueWords({ value }: EntryRecord): string {
  const text = JSON.stringify(value, undefined, 1)
  return text.length > MOST_SHOWN ? `${text.slice(0, MOST_SHOWN)} …` : text
}
