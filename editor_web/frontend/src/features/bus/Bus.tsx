/** The skill bus: topics with their traffic and messages, services, actions and parameters with forms, who holds what. */
import { lookup } from '../../document/dict'
import { Box, CloseButton, Group, NativeSelect, SegmentedControl, TextInput } from '@mantine/core'
import { useElementSize } from '@mantine/hooks'
import { IconPlugConnected, IconSearch } from '@tabler/icons-react'
import { useEffect, useMemo, useRef, useState } from 'react'
import { busQueries } from '../../api/bus'
import { useData } from '../../api/data'
import { useLastAnswer } from '../../api/queryClient'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { useIsVisible } from '../../components/useIsVisible'
import { found } from '../../document/busTree'
import { entriesOf, KINDS, type BusKind } from './entries'
import { EntryList } from './EntryList'
import { Leases } from './Leases'
import { ParameterView } from './ParameterView'
import { leave } from './requests'
import { SkillView } from './SkillView'
import { TopicView } from './TopicView'
import type { BusListing, BusMetricsFrame, MessageFrame } from '../../api/types'
import classes from './bus.module.css'

interface BusProps {
  readonly session: { readonly role: string } | undefined
}

export function Bus({ session }: BusProps) {
  const area = useRef<HTMLDivElement>(null)
  const isShown = useIsVisible(area)
  const { ref: toolsRef, width } = useElementSize()
  const [kind, setKind] = useState<BusKind>('topics')
  const [search, setSearch] = useState('')
  const [chosen, setChosen] = useState<Readonly<Partial<Record<BusKind, string>>>>({})
  const [traffic, setTraffic] = useState<BusMetricsFrame>()
  const [message, setMessage] = useState<MessageFrame>()
  const name = chosen[kind]
  const topic = kind === 'topics' && name ? name : ''
  const { value: board, problem } = useLastAnswer(busQueries.listing(traffic?.shape))

  useData(isShown ? { traffic: true, topic } : undefined, (frame) => {
    if (frame.k === 'traffic') setTraffic(frame)
    if (frame.k === 'message') setMessage(frame)
  })
  // Whoever goes lets the server cancel what was sent.
  useEffect(() => leave, [])

  const all = useMemo(() => (board ? entriesOf(board, kind) : []), [board, kind])
  const entries = useMemo(() => found(all, search), [all, search])
  const mayChange = session?.role === 'operator'

  function choose(entry: string): void {
    setChosen({ ...chosen, [kind]: entry })
  }

  const tools = (
    <Group ref={toolsRef} gap="xs" wrap="nowrap" flex={1} miw={0}>
      {width === 0 ? null : width > 520 ? (
        <SegmentedControl size="xs" aria-label="Part of the bus" data={KINDS} value={kind} onChange={(value) => setKind(value)} />
      ) : (
        <NativeSelect
          size="xs"
          aria-label="Part of the bus"
          value={kind}
          onChange={(event) => setKind(event.currentTarget.value as BusKind)}
        >
          {KINDS.map((each) => (
            <option key={each.value} value={each.value}>
              {each.label}
            </option>
          ))}
        </NativeSelect>
      )}
      <TextInput
        size="xs"
        aria-label="Find on the bus"
        placeholder="Find"
        leftSection={<IconSearch size={14} aria-hidden />}
        rightSection={search && <CloseButton size="xs" aria-label="Clear" onClick={() => setSearch('')} />}
        value={search}
        onChange={(event) => setSearch(event.currentTarget.value)}
        flex="0 1 180px"
        miw={70}
        ml="auto"
      />
    </Group>
  )

  function body() {
    if (problem) return <Empty title="The bus cannot be shown">{problem}</Empty>
    if (!board) return <div role="status" aria-label="Loading" />
    if (kind === 'leases') return <Leases leases={traffic?.leases ?? []} goals={traffic?.goals ?? []} search={search} />
    if (entries.length === 0) return <NoEntries kind={kind} isFiltered={all.length > 0} />
    return (
      <div className={classes.halves} data-chosen={name ? true : undefined}>
        <EntryList key={kind} entries={entries} kind={kind} chosen={name} onChoose={choose} traffic={traffic?.topics} />
        <Box className={classes.detail} px="sm" pt="2xs" pb="sm" role="group" aria-label="What is selected" tabIndex={0}>
          {detail(board)}
        </Box>
      </div>
    )
  }

  function detail(known: BusListing) {
    if (!name) return <Empty title="Nothing is selected">Select an entry on the left to see its description, messages and requests.</Empty>
    const shared = { mayChange, onBack: () => setChosen({ ...chosen, [kind]: undefined }) }
    const facts = known.topics.find((each) => each.name === name)
    if (kind === 'topics' && facts) {
      const latest = message?.topic === name ? message : undefined
      return <TopicView key={name} {...shared} facts={facts} message={latest} traffic={lookup(traffic?.topics, name)} />
    }
    const parameter = known.parameters.find((each) => each.name === name)
    if (kind === 'parameters' && parameter) return <ParameterView key={name} {...shared} facts={parameter} />
    const skill = known.skills.find((each) => each.name === name)
    if (skill) return <SkillView key={name} {...shared} facts={skill} />
    return <Empty title={`${name} is no longer there`}>Its device has left the bus.</Empty>
  }

  return (
    <Panel title="Bus" tools={tools}>
      <div className={classes.bus} ref={area}>
        {body()}
      </div>
    </Panel>
  )
}

function NoEntries({ kind, isFiltered }: { kind: BusKind; isFiltered: boolean }) {
  const icon = <IconPlugConnected size={26} stroke={1.4} aria-hidden />
  if (isFiltered)
    return (
      <Empty icon={icon} title="Nothing matches">
        Clear the search to see everything.
      </Empty>
    )
  return (
    <Empty icon={icon} title={`There are no ${kind}`}>
      The robots and modules of a cell bring them: serve one with <code>flexcell serve --cell FILE</code>.
    </Empty>
  )
}
