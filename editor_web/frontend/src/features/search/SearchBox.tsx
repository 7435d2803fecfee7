/** Leads to anything by its name, and runs the commands of the page that is shown, from the keyboard. */
import { useDebouncedValue } from '@mantine/hooks'
import { IconBroadcast, IconCommand, IconCube, IconHistory, IconMapPin } from '@tabler/icons-react'
import { useMemo, useState, type ReactNode } from 'react'
import { useLastAnswer } from '../../api/queryClient'
import { closeSearch, namesQuery, pageCommands, type PageCommand } from '../../api/search'
import type { NameHit } from '../../api/types'
import { ChoiceBox, type Choice } from '../../components/ChoiceBox'
import { KindIcon } from '../../components/KindIcon'

export interface SearchBoxProps {
  /** The pages that can be gone to from everywhere. */
  readonly pages: readonly PageCommand[]
  /** The behavior that is edited; it offers its nodes itself, as they are now. */
  readonly edited: string | undefined
  readonly onOpen: (hit: NameHit) => void
}

const DELAY_MS = 120
const SIZE = 15

/** What runs is drawn as its kind of node. */
const KINDS: Readonly<Record<NameHit['kind'], { readonly group: string; readonly icon?: ReactNode }>> = {
  behavior: { group: 'Behaviors' },
  node: { group: 'States and containers' },
  state: { group: 'States of the library: find usages' },
  entry: { group: 'Entries', icon: <IconMapPin size={SIZE} aria-hidden /> },
  item: { group: 'Items of the cell', icon: <IconCube size={SIZE} aria-hidden /> },
  topic: { group: 'Topics', icon: <IconBroadcast size={SIZE} aria-hidden /> },
  run: { group: 'Runs', icon: <IconHistory size={SIZE} aria-hidden /> },
}

export function SearchBox({ pages, edited, onOpen }: SearchBoxProps) {
  const [text, setText] = useState('')
  const [asked] = useDebouncedValue(text.trim(), DELAY_MS)
  const { hits, problem } = useHits(asked)
  const choices = useMemo(
    () =>
      [...pageCommands(), ...pages].map((each): Choice => ({
        ...each,
        icon: each.icon === undefined ? <IconCommand size={SIZE} aria-hidden /> : <KindIcon icon={each.icon} size={SIZE} />,
      })),
    [pages],
  )
  return (
    <ChoiceBox
      label="Search"
      placeholder="Go to a behavior, state, entry, run, item or topic, or type a command …"
      choices={choices}
      hits={hits.filter((hit) => hit.kind !== 'node' || hit.id !== edited).map((hit) => choiceOf(hit, onOpen))}
      onText={setText}
      nothing={problem || undefined}
      onClose={closeSearch}
    />
  )
}

function choiceOf(hit: NameHit, onOpen: SearchBoxProps['onOpen']): Choice {
  const { group, icon = <KindIcon icon={hit.icon} size={SIZE} /> } = KINDS[hit.kind]
  return { id: `${hit.kind}:${hit.id}:${hit.path}`, title: hit.title, detail: hit.detail, group, icon, run: () => onOpen(hit) }
}

const NOTHING: readonly NameHit[] = []

/** What the server finds for a text; that of before until it has answered. */
function useHits(text: string): { readonly hits: readonly NameHit[]; readonly problem: string } {
  const { value = NOTHING, problem = '' } = useLastAnswer(namesQuery(text))
  if (text === '') return { hits: NOTHING, problem: '' }
  return { hits: problem ? NOTHING : value, problem }
}
