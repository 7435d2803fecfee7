/** The userdata of the shown run: every value of every container, who wrote it last and when. */
import { ActionIcon, Anchor, Badge, Box, CloseButton, Group, List, Text, TextInput, Title } from '@mantine/core'
import { IconDatabase, IconEye, IconPencil, IconSearch } from '@tabler/icons-react'
import { memo, useMemo, useRef, useState, type ReactNode } from 'react'
import { api } from '../../api/client'
import { useData } from '../../api/data'
import { useLive } from '../../api/live'
import { usePastValues } from '../../api/pastValues'
import { send, showRefusal } from '../../api/refusal'
import { Empty } from '../../components/Empty'
import { Panel } from '../../components/Panel'
import { useIsVisible } from '../../components/useIsVisible'
import { ValueTree } from '../../components/ValueTree'
import { disabledReason } from '../../document/commands'
import { isActive } from '../../document/runState'
import { containerOf, namesIn, shownScopes, withChanges, type Scopes } from '../../document/userdata'
import { inShort, isShort } from '../../document/values'
import type { BehaviorView, UserdataRecord, WatchValue } from '../../api/types'
import { useWatches, watchValueOf } from '../../api/watches'
import classes from './data.module.css'
import { ValueEditor } from './ValueEditor'
import { Watches } from './Watches'

const NO_VALUES: readonly WatchValue[] = []

interface DataProps {
  readonly run: { readonly id: string } | undefined
  readonly behavior: Pick<BehaviorView, 'id' | 'parameters'>
  /** The selected node, if any. */
  readonly node?: string | undefined
  readonly onShow: (path: string) => void
}

export function Data({ run, behavior, node, onShow }: DataProps) {
  const area = useRef<HTMLDivElement>(null)
  const isShown = useIsVisible(area)
  const [search, setSearch] = useState('')
  const [latest, setLatest] = useState<{
    readonly run: string
    readonly scopes: Scopes
    readonly watches: readonly WatchValue[]
    readonly problem: string
  }>()

  const watches = useWatches(behavior.id)
  const past = usePastValues(run?.id, isShown, watches)

  useData(isShown && run && !past ? { run: run.id, ...(watches.length > 0 && { watches }) } : undefined, (frame) => {
    if (frame.k !== 'userdata') return
    setLatest((before) => ({
      run: frame.run,
      scopes: withChanges(before?.run === frame.run ? before.scopes : {}, frame.scopes, frame.first),
      watches: frame.watches,
      problem: frame.problem,
    }))
  })
  const changing = useChanging(run?.id, past !== undefined)
  const current = past ?? (latest?.run === run?.id ? latest : undefined)
  const names = useMemo(() => namesIn(current?.scopes ?? {}, behavior.parameters), [current, behavior.parameters])
  const scopes = useMemo(() => shownScopes(current?.scopes ?? {}, search), [current, search])

  const tools = (
    <Group flex={1} justify="end" miw={0}>
      <TextInput
        size="xs"
        aria-label="Find in the data"
        placeholder="Find"
        leftSection={<IconSearch size={14} aria-hidden />}
        rightSection={search && <CloseButton size="xs" aria-label="Clear" onClick={() => setSearch('')} />}
        value={search}
        onChange={(event) => setSearch(event.currentTarget.value)}
        flex="0 1 180px"
        miw={70}
      />
    </Group>
  )

  function body() {
    if (!run) return <NoData title="No run is shown">Start the behavior; the userdata of its states appears here.</NoData>
    if (!current) return <div role="status" aria-label="Loading" />
    if (current.problem) return <NoData title="The data cannot be shown">{current.problem}</NoData>
    if (scopes.length === 0 && search) return <NoData title="Nothing matches">Clear the search to see everything.</NoData>
    if (scopes.length === 0)
      return (
        <NoData title="This behavior shares no data">
          States share values that stand under <code>userdata</code> of the behavior or a container.
        </NoData>
      )
    return (
      <>
        {scopes.map((scope) => (
          <section key={scope.path} aria-label={scope.name}>
            <Title
              order={3}
              pos="sticky"
              top={0}
              bg="var(--surface)"
              style={{ zIndex: 1 }}
              px="sm"
              py="4xs"
              fz="0.76rem"
              fw={620}
              c="dimmed"
              ff="monospace"
            >
              {scope.name}
              {!scope.isOpen && (
                <Badge component="span" variant="default" size="xs" tt="none" ml="2xs">
                  over
                </Badge>
              )}
            </Title>
            <List listStyleType="none" fz="inherit">
              {scope.lines.map((line) => (
                <Line
                  key={line.key}
                  name={line.key}
                  line={line}
                  onShow={onShow}
                  changing={scope.isOpen ? changing : undefined}
                  load={async () => (await api.userdata(run.id, scope.path, line.key)).value}
                  onSave={(value) => api.setUserdata(run.id, scope.path, line.key, value)}
                  onWatch={() => watchValueOf(behavior.id, { expression: line.key, ...(scope.path && { path: containerOf(scope.path) }) })}
                />
              ))}
            </List>
          </section>
        ))}
      </>
    )
  }

  return (
    <Panel title="Data" tools={tools}>
      <Box pos="absolute" inset={0} className={classes.data} ref={area}>
        <Box className="pane" fz="0.8rem" tabIndex={0} role="region" aria-label="Userdata">
          {run && <Watches behavior={behavior.id} values={current?.watches ?? NO_VALUES} names={names} node={node} />}
          {body()}
        </Box>
      </Box>
    </Panel>
  )
}

/** Whether values can be changed, and why not now; undefined where there is nothing to change: the past, or a run that has ended. */
interface Changing {
  readonly obstacle: string | undefined
}

function useChanging(id: string | undefined, isPast: boolean): Changing | undefined {
  const run = useLive((s) => s.runs.find((each) => each.id === id))
  const role = useLive((s) => s.role)
  const isConnected = useLive((s) => s.connection === 'live')
  const control = useLive((s) => s.control)
  if (isPast || !isActive(run)) return undefined
  return { obstacle: disabledReason('userdata', { role, isConnected, run, control, node: undefined, nodeStatus: 'idle' }) }
}

function NoData({ title, children }: { title: string; children: ReactNode }) {
  return (
    <Empty icon={<IconDatabase size={26} stroke={1.4} aria-hidden />} title={title}>
      {children}
    </Empty>
  )
}

interface LineProps {
  readonly name: string
  readonly line: UserdataRecord
  readonly onShow: (path: string) => void
  readonly onWatch: () => void
  readonly changing: Changing | undefined
  /** The whole value; what the line shows of a large one is truncated. */
  readonly load: () => Promise<unknown>
  readonly onSave: (value: unknown) => Promise<unknown>
}

/** Drawn again when it is written again, and lit for a moment then. */
const Line = memo(
  function Line({ name, line, onShow, onWatch, changing, load, onSave }: LineProps) {
    const [edited, setEdited] = useState<{ readonly value: unknown }>()
    const obstacle = changing?.obstacle
    const whole = changing && obstacle === undefined ? edited : undefined

    async function edit(): Promise<void> {
      if (obstacle !== undefined) showRefusal(`Change ${name}`, obstacle)
      else setEdited(await send(`Change ${name}`, async () => ({ value: await load() })))
    }

    return (
      <li className={classes.line}>
        <Group gap={4} wrap="nowrap" align="start" justify="space-between">
          <Text span inherit ff="monospace" fw={600}>
            {name}
          </Text>
          <Group gap={2} wrap="nowrap">
            {changing && (
              <ActionIcon
                variant="subtle"
                color="gray"
                size={18}
                aria-label={`Change ${name}`}
                title={obstacle ? `Not possible: ${obstacle}` : 'Change it'}
                aria-disabled={obstacle !== undefined}
                {...(obstacle !== undefined && { 'data-disabled': true })}
                onClick={() => void edit()}
              >
                <IconPencil size={13} aria-hidden />
              </ActionIcon>
            )}
            <ActionIcon variant="subtle" color="gray" size={18} aria-label={`Watch ${name}`} title="Watch it" onClick={onWatch}>
              <IconEye size={13} aria-hidden />
            </ActionIcon>
          </Group>
        </Group>
        <span className={classes.value} key={line.writes} data-written={line.writes > 0 || undefined}>
          {whole ? (
            <ValueEditor name={name} value={whole.value} onSave={onSave} onClose={() => setEdited(undefined)} />
          ) : isShort(line.value) ? (
            <Text span inherit ff="monospace">
              {inShort(line.value)}
            </Text>
          ) : (
            <ValueTree label={`Value of ${name}`} value={line.value} open={0} />
          )}
        </span>
        <span>
          {line.by ? (
            <>
              <Anchor c="var(--accent)" component="button" type="button" inherit ta="start" onClick={() => onShow(line.by)}>
                {line.by}
              </Anchor>
              <Text span inherit c="dimmed">
                {' '}
                at {line.at_s.toFixed(2)} s{line.writes > 1 && `, ×${line.writes}`}
              </Text>
            </>
          ) : (
            <Text span inherit c="dimmed">
              {line.writes > 0 ? `set by a person at ${line.at_s.toFixed(2)} s` : 'from the start'}
            </Text>
          )}
        </span>
      </li>
    )
  },
  (before, after) =>
    before.line.at_s === after.line.at_s &&
    before.line.writes === after.line.writes &&
    before.line.by === after.line.by &&
    (before.changing === undefined) === (after.changing === undefined) &&
    before.changing?.obstacle === after.changing?.obstacle,
)
