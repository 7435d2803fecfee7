/** The library: everything that can be put into the behavior, by group, with search and what each is for. */
import { CloseButton, TextInput } from '@mantine/core'
import { IconChevronDown, IconChevronRight, IconInfoCircle, IconMapPin, IconSearch } from '@tabler/icons-react'
import { useMemo, useState, type ReactNode } from 'react'
import type { CatalogueBody } from '../../api/types'
import { Panel } from '../../components/Panel'
import { PLACED } from '../../document/editing/preview'
import { found } from '../../document/editing/search'
import { add, type Addition } from './actions'
import { entryAddition, itemIcon, itemsOf, type Item } from './additions'
import { placeForNew } from './paletteRequests'
import { ADDITION } from './dragging'
import { LibraryPreview } from './ShowEntry'
import { showEditorRefusal, useEditor } from './store'

export function LibraryPanel({ tools }: { tools?: ReactNode }) {
  const catalogue = useEditor((s) => s.catalogue)
  const id = useEditor((s) => s.id)
  const [text, setText] = useState('')
  const [explained, setExplained] = useState<string>()
  const items = useMemo(() => (catalogue ? [...itemsOf(catalogue, id), ...entryItems(catalogue)] : []), [catalogue, id])
  const fitting = found(items, text, (item) => [item.title, item.group, item.summary])
  const groups = [...new Set(fitting.map((item) => item.group))]
  return (
    <Panel title="Library" className="library">
      <div className="library-search">
        <TextInput
          size="xs"
          aria-label="Find in the library"
          placeholder="Find"
          leftSection={<IconSearch size={14} aria-hidden />}
          rightSection={text && <CloseButton size="xs" aria-label="Clear" onClick={() => setText('')} />}
          value={text}
          onChange={(event) => setText(event.currentTarget.value)}
        />
        {tools}
      </div>
      <div className="library-list">
        {groups.map((group) => (
          <LibraryGroup
            key={group}
            title={group}
            items={fitting.filter((item) => item.group === group)}
            isSearching={text.trim() !== ''}
            explained={explained}
            onExplain={(item) => setExplained(explained === item ? undefined : item)}
          />
        ))}
        {groups.length === 0 && <p className="quiet library-none">Nothing in the library fits.</p>}
      </div>
    </Panel>
  )
}

function entryItems(catalogue: CatalogueBody): readonly Item[] {
  return catalogue.entries.flatMap((entry) => {
    const addition = entryAddition(entry, catalogue)
    if (!addition) return []
    return [
      {
        id: `entry:${entry.kind}:${entry.name}`,
        title: entry.name,
        group: 'Entries',
        summary: entry.kind,
        doc: `A named ${entry.kind}. Adds ${addition.runs ?? ''} that goes there.`,
        outcomes: [],
        kind: 'entry',
        onlyInTree: false,
        addition,
        entry,
      },
    ]
  })
}

interface GroupProps {
  readonly title: string
  readonly items: readonly Item[]
  readonly isSearching: boolean
  readonly explained: string | undefined
  readonly onExplain: (item: string) => void
}

function LibraryGroup({ title, items, isSearching, explained, onExplain }: GroupProps) {
  const [isClosed, setClosed] = useState(title === 'Entries')
  const isOpen = isSearching || !isClosed
  const Chevron = isOpen ? IconChevronDown : IconChevronRight
  return (
    <section className="library-group" aria-label={title}>
      <button type="button" className="library-head" aria-expanded={isOpen} onClick={() => setClosed(!isClosed)}>
        <Chevron size={14} aria-hidden />
        {title}
        <span className="library-count">{items.length}</span>
      </button>
      {isOpen && (
        <ul className="plain-list">
          {items.map((item) => (
            <LibraryItem key={item.id} item={item} isExplained={explained === item.id} onExplain={() => onExplain(item.id)} />
          ))}
        </ul>
      )}
    </section>
  )
}

function LibraryItem({ item, isExplained, onExplain }: { item: Item; isExplained: boolean; onExplain: () => void }) {
  const short = item.title.startsWith(`${item.group}.`) ? item.title.slice(item.group.length + 1) : item.title
  return (
    <li className="library-item">
      <div className="library-row">
        <button
          type="button"
          className="library-add"
          draggable
          title={`${item.summary}\nClick to add, or drag to the canvas`}
          aria-label={`Add ${item.title}`}
          onDragStart={(event) => {
            event.dataTransfer.setData(ADDITION, JSON.stringify(item.addition))
            event.dataTransfer.effectAllowed = 'copy'
          }}
          onClick={() => addHere(item.addition)}
        >
          <span className="library-icon">{item.kind === 'entry' ? <IconMapPin size={15} aria-hidden /> : itemIcon(item.kind, 15)}</span>
          <span className="library-name">{short}</span>
        </button>
        {item.entry && item.entry.kind in PLACED && <LibraryPreview entry={item.entry} />}
        <button type="button" className="library-info" aria-expanded={isExplained} aria-label={`What is ${item.title}`} onClick={onExplain}>
          <IconInfoCircle size={15} aria-hidden />
        </button>
      </div>
      {isExplained && (
        <div className="library-doc">
          {item.doc.split(/\n\s*\n/).map((paragraph, index) => (
            <p key={index}>{paragraph}</p>
          ))}
          {item.outcomes.length > 0 && <p className="quiet">Outcomes: {item.outcomes.join(', ')}</p>}
        </div>
      )}
    </li>
  )
}

/** Into the selected container, or after the selected node. */
function addHere(addition: Addition): void {
  const parent = placeForNew()
  if (parent) void add(addition, { parent: parent.path })
  else showEditorRefusal('Add', 'nothing can be put in here', 'Select a container.')
}
