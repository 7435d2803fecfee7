/** The named entries of the cell: found, looked at, played back, undone. */
import { NativeSelect, TextInput } from '@mantine/core'
import { IconArrowBackUp, IconEye, IconTrash } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { forgiveTeach, teach, tellServer, useObstacle, useTeach, type EntryChange } from '../../api/teaching'
import type { EntryPage, EntryRow } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { Empty } from '../../components/Empty'
import { wallTime } from '../../document/time'
import { PlayBack } from './PlayBack'

const KINDS = ['joints', 'pose', 'dmp', 'cart_dmp', 'trajectory', 'gripper', 'cart_offsets', 'record']
/** What an arm can carry out. */
const PLAYED = new Set(['joints', 'pose', 'dmp', 'cart_dmp', 'trajectory'])
const TYPING_MS = 150

export function EntryList({ arm }: { readonly arm: string }) {
  const [text, setText] = useState('')
  const [kind, setKind] = useState('')
  const [chosen, setChosen] = useState('')
  const { page, problem } = useEntries(kind, text)
  const one = page?.entries.find((each) => keyOf(each) === chosen)
  return (
    <div className="entries">
      <div className="entry-search">
        <TextInput size="xs" label="Search" placeholder="name or tag" value={text} onChange={(event) => setText(event.currentTarget.value)} autoComplete="off" />
        <NativeSelect size="xs" label="Kind" value={kind} onChange={(event) => setKind(event.currentTarget.value)} data={[{ value: '', label: 'all' }, ...KINDS]} />
      </div>
      {problem && (
        <p className="teach-problem" role="alert">
          {problem}
        </p>
      )}
      {page && page.entries.length === 0 ? (
        <Empty title={text || kind ? 'Nothing is found' : 'No entries yet'}>{text || kind ? 'Search for the beginning of a word of the name or of a tag.' : 'Capture something and save it under a name.'}</Empty>
      ) : (
        <ul className="plain-list entry-list" aria-label="Entries">
          {page?.entries.map((each) => (
            <li key={keyOf(each)}>
              <button type="button" className={`entry${keyOf(each) === chosen ? ' is-current' : ''}`} aria-pressed={keyOf(each) === chosen} onClick={() => setChosen(keyOf(each))}>
                <span className="entry-kind">{each.kind}</span>
                <span className="entry-name">{each.name}</span>
                <span className="entry-tags">
                  {each.tags.map((tag) => (
                    <span key={tag} className="tag">
                      {tag}
                    </span>
                  ))}
                </span>
              </button>
            </li>
          ))}
        </ul>
      )}
      {page && page.total > page.entries.length && (
        <p className="quiet">
          The first {page.entries.length} of {page.total}; search to see others.
        </p>
      )}
      {one && <EntryDetails key={keyOf(one)} arm={arm} entry={one} />}
    </div>
  )
}

function keyOf(entry: EntryRow): string {
  return `${entry.kind} ${entry.name}`
}

function EntryDetails({ arm, entry }: { readonly arm: string; readonly entry: EntryRow }) {
  const off = useObstacle()
  const looked = useTeach((s) => s.refused.look)
  const [problem, setProblem] = useState('')
  const { kind, name } = entry
  const history = useHistory(entry)

  function attempt(work: () => Promise<unknown>): void {
    work().then(
      () => setProblem(''),
      (error: unknown) => setProblem(wordsOf(error)),
    )
  }

  function look(): void {
    forgiveTeach('look')
    tellServer({ k: 'look', arm, kind, name, capture: 0 })
  }

  return (
    <section className="teach-part" aria-label={`Entry ${kind} ${name}`}>
      <h3>
        {name} <span className="quiet">{kind}</span>
      </h3>
      <div className="command-row">
        {PLAYED.has(kind) && <CommandButton label="Show in the cell" icon={<IconEye size={15} aria-hidden />} onPress={look} />}
        <CommandButton label="Undo" hint="Bring back what it was before the last change" icon={<IconArrowBackUp size={15} aria-hidden />} obstacle={off} onPress={() => attempt(() => teach.undo(kind, name))} />
        <CommandButton label="Delete" hint="Undo brings it back" tone="quiet" icon={<IconTrash size={15} aria-hidden />} obstacle={off} onPress={() => attempt(() => teach.remove(kind, name))} />
      </div>
      {(problem || looked) && (
        <p className="teach-problem" role="alert">
          {problem || looked?.message}
        </p>
      )}
      {PLAYED.has(kind) && <PlayBack arm={arm} what={{ kind, name, capture: 0 }} words={`${kind} ${name}`} onLook={look} />}
      <h4>History</h4>
      <ol className="plain-list history" aria-label={`History of ${name}`}>
        {[...history].reverse().map((change) => (
          <li key={change.revision}>
            <span className="mono">{change.revision}</span> {change.deleted ? 'deleted' : change.revision === 1 ? 'made' : 'changed'}
            {change.by && ` by ${change.by}`}, {wallTime(change.changed_unix_ms / 1000)}
            {change.reason && <span className="quiet"> – {change.reason}</span>}
          </li>
        ))}
      </ol>
    </section>
  )
}

function useHistory({ kind, name, revision }: EntryRow): readonly EntryChange[] {
  const [changes, setChanges] = useState<readonly EntryChange[]>([])
  useEffect(() => {
    let current = true
    teach.history(kind, name).then(
      (found) => current && setChanges(found.changes),
      () => current && setChanges([]),
    )
    return () => {
      current = false
    }
  }, [kind, name, revision])
  return changes
}

function useEntries(kind: string, text: string): { readonly page: EntryPage | undefined; readonly problem: string } {
  const changed = useTeach((s) => s.entries)
  const [page, setPage] = useState<EntryPage>()
  const [problem, setProblem] = useState('')
  useEffect(() => {
    let current = true
    const asked = setTimeout(() => {
      teach.entries(kind, text).then(
        (found) => {
          if (!current) return
          setPage(found)
          setProblem('')
        },
        (error: unknown) => current && setProblem(wordsOf(error)),
      )
    }, TYPING_MS)
    return () => {
      current = false
      clearTimeout(asked)
    }
  }, [kind, text, changed])
  return { page, problem }
}
