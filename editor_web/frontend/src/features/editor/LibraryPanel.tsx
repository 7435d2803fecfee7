/** The library: everything that can be put into the behavior, by group, with search and what each is for. */
import { ActionIcon, Box, CloseButton, Flex, Stack, Text, TextInput, UnstyledButton } from '@mantine/core'
import { IconChevronDown, IconChevronRight, IconInfoCircle, IconMapPin, IconSearch } from '@tabler/icons-react'
import { useMemo, useState, type ReactNode } from 'react'
import type { CatalogueBody } from '../../api/types'
import { findUsages } from '../../api/usages'
import { KindIcon } from '../../components/KindIcon'
import { Panel } from '../../components/Panel'
import { TextButton } from '../../components/TextButton'
import { PLACED } from '../../document/editing/preview'
import { found } from '../../document/editing/search'
import type { Used } from '../../document/editing/usedBy'
import { add, type Addition } from './actions'
import { entryAddition, itemsOf, type Item } from './additions'
import { placeForNew } from './paletteRequests'
import { ADDITION } from './dragging'
import { FormWords } from './FormParts'
import { PlainList } from './PlainList'
import rows from './row.module.css'
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
    <Panel title="Library">
      <Stack gap={0} h="100%">
        <Stack gap={6} px={8} pt={8} pb={6}>
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
        </Stack>
        <Box flex={1} mih={0} px={4} pb="sm" style={{ overflowY: 'auto' }}>
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
          {groups.length === 0 && <FormWords>{catalogue ? 'Nothing in the library fits.' : 'Loading…'}</FormWords>}
        </Box>
      </Stack>
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
        icon: '',
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
    <section aria-label={title}>
      <UnstyledButton w="100%" px={5} pt={6} pb={4} aria-expanded={isOpen} onClick={() => setClosed(!isClosed)}>
        <Flex align="center" gap={5} fz="xs" fw={620} c="dimmed">
          <Chevron size={14} aria-hidden />
          {title}
          <Text span inherit fw={450} ml="auto" pr={6}>
            {items.length}
          </Text>
        </Flex>
      </UnstyledButton>
      {isOpen && (
        <PlainList>
          {items.map((item) => (
            <LibraryItem key={item.id} item={item} isExplained={explained === item.id} onExplain={() => onExplain(item.id)} />
          ))}
        </PlainList>
      )}
    </section>
  )
}

function LibraryItem({ item, isExplained, onExplain }: { item: Item; isExplained: boolean; onExplain: () => void }) {
  const used = usedIn(item)
  // Entries of several kinds may have one name.
  const title = item.entry ? `${item.title} (${item.entry.kind})` : item.title
  const short = item.title.startsWith(`${item.group}.`) ? item.title.slice(item.group.length + 1) : item.title
  return (
    <li>
      <Flex className={rows['around']}>
        <UnstyledButton
          className={`${rows['row']} pick-row`}
          px={6}
          py={3}
          style={{ cursor: 'grab' }}
          draggable
          title={`${item.summary}\nClick to add, or drag to the canvas`}
          aria-label={`Add ${title}`}
          onDragStart={(event) => {
            event.dataTransfer.setData(ADDITION, JSON.stringify(item.addition))
            event.dataTransfer.effectAllowed = 'copy'
          }}
          onClick={() => addHere(item.addition)}
        >
          {item.icon === '' ? <IconMapPin size={15} aria-hidden /> : <KindIcon icon={item.icon} size={15} />}
          <span className={rows['line']}>{short}</span>
        </UnstyledButton>
        {item.entry && item.entry.kind in PLACED && <LibraryPreview entry={item.entry} />}
        <ActionIcon
          variant="subtle"
          color="gray"
          size={28}
          className={rows['aside']}
          aria-expanded={isExplained}
          aria-label={`What is ${title}`}
          onClick={onExplain}
        >
          <IconInfoCircle size={15} aria-hidden />
        </ActionIcon>
      </Flex>
      {isExplained && (
        <Stack gap={4} fz="xs" pl="xl" pr={6} pb={6}>
          {item.doc.split(/\n\s*\n/).map((paragraph, index) => (
            <div key={index}>{paragraph}</div>
          ))}
          {item.outcomes.length > 0 && <FormWords>Outcomes: {item.outcomes.join(', ')}</FormWords>}
          {used && <TextButton onPress={() => findUsages(used)}>Find usages</TextButton>}
        </Stack>
      )}
    </li>
  )
}

function usedIn({ id, kind, entry }: Item): Used | undefined {
  if (entry) return { kind: 'entry', name: entry.name }
  return kind === 'state' || (kind === 'behavior' && id.startsWith('behavior:')) ? { kind, name: id.slice(kind.length + 1) } : undefined
}

/** Into the selected container, or after the selected node. */
function addHere(addition: Addition): void {
  const parent = placeForNew()
  if (parent) void add(addition, { parent: parent.path })
  else showEditorRefusal('Add', 'nothing can be put in here', 'Select a container.')
}
