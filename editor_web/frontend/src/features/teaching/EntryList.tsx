/** The named entries of the cell: found, and laid beside each other. */
import { Checkbox, NativeSelect, TextInput } from '@mantine/core'
import { useDebouncedValue } from '@mantine/hooks'
import { useState } from 'react'
import { entryQueries } from '../../api/entries'
import { useLastAnswer, type Answer } from '../../api/queryClient'
import type { EntryPage, EntryChanged } from '../../api/types'
import { Empty } from '../../components/Empty'
import { Comparison, MOST_COMPARED, type Compared } from './Comparison'
import { EntryDetails } from './EntryDetails'
import { PLAYED } from './forms'

const KINDS = ['joints', 'pose', 'dmp', 'cart_dmp', 'trajectory', 'gripper', 'cart_offsets', 'record']
const TYPING_MS = 150

export function EntryList({ arm }: { readonly arm: string }) {
  const [text, setText] = useState('')
  const [kind, setKind] = useState('')
  const [chosen, setChosen] = useState('')
  const [compared, setCompared] = useState<readonly string[]>([])
  const { value: page, problem } = useEntries(kind, text)
  const one = page?.entries.find((each) => keyOf(each) === chosen)
  const beside = page?.entries.filter((each) => compared.includes(keyOf(each))) ?? []
  return (
    <div className="entries">
      <div className="entry-search">
        <TextInput
          size="xs"
          label="Search"
          placeholder="name or tag"
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
          autoComplete="off"
        />
        <NativeSelect
          size="xs"
          label="Kind"
          value={kind}
          onChange={(event) => setKind(event.currentTarget.value)}
          data={[{ value: '', label: 'all' }, ...KINDS]}
        />
      </div>
      {problem && (
        <p className="teach-problem" role="alert">
          {problem}
        </p>
      )}
      {page && page.entries.length === 0 ? (
        <Empty title={text || kind ? 'Nothing is found' : 'No entries yet'}>
          {text || kind ? 'Search for the beginning of a word of the name or of a tag.' : 'Capture something and save it under a name.'}
        </Empty>
      ) : (
        <ul className="plain-list entry-list" aria-label="Entries">
          {page?.entries.map((each) => (
            <li key={keyOf(each)} className={`entry-row${keyOf(each) === chosen ? ' is-current' : ''}`}>
              <Checkbox
                size="xs"
                aria-label={`Compare ${keyOf(each)}`}
                title="Compare"
                checked={compared.includes(keyOf(each))}
                disabled={!PLAYED.has(each.kind) || (beside.length >= MOST_COMPARED && !compared.includes(keyOf(each)))}
                onChange={(event) =>
                  setCompared(event.currentTarget.checked ? [...compared, keyOf(each)] : compared.filter((key) => key !== keyOf(each)))
                }
              />
              <button type="button" className="entry" aria-pressed={keyOf(each) === chosen} onClick={() => setChosen(keyOf(each))}>
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
      {beside.length > 0 && (
        <section aria-label="Comparison" className="teach-part">
          <h3>Side by side</h3>
          {beside.length < 2 && <p className="quiet">Choose another one to compare it with.</p>}
          <Comparison things={beside.map((each) => asCompared(each, arm))} />
        </section>
      )}
      {one && <EntryDetails key={keyOf(one)} arm={arm} entry={one} />}
    </div>
  )
}

function keyOf(entry: EntryChanged): string {
  return `${entry.kind} ${entry.name}`
}

/** As it is at its revision, so that a change is asked for anew. */
function asCompared({ kind, name, revision }: EntryChanged, arm: string): Compared {
  return { key: `${kind} ${name}`, label: name, arm, what: { kind, name, capture: 0, revision } }
}

function useEntries(kind: string, text: string): Answer<EntryPage> {
  const [typed] = useDebouncedValue(text, TYPING_MS)
  return useLastAnswer(entryQueries.found(kind, typed))
}
