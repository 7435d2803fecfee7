/** The whole page: connection, session, navigation, and the page of the address. */
import { AppShell, Burger, Kbd, NavLink } from '@mantine/core'
import { useDisclosure, useMediaQuery } from '@mantine/hooks'
import { IconChartDots, IconCube, IconHistory, IconLayoutGrid, IconSearch } from '@tabler/icons-react'
import { useEffect, type ReactNode } from 'react'
import { behaviorQueries } from '../api/behaviorQueries'
import { connect, useLive, watch } from '../api/live'
import { useAnswer, useOutdated } from '../api/queryClient'
import { queryKeys } from '../api/queryKeys'
import { showKeys, useKeyMap, useKeyOf } from '../api/keyMap'
import { findUsages, useUsages } from '../api/usages'
import { openSearch, type PageCommand } from '../api/search'
import { showPresence } from '../api/presence'
import { useRealDevices } from '../api/realDevices'
import { useSession } from '../api/session'
import { useTour } from '../api/tour'
import type { NameHit, RunView } from '../api/types'
import { WhileLoading, lazyView } from '../components/lazyView'
import { Loading } from '../components/Loading'
import { NoticePlace } from '../components/NoticePlace'
import { SIDE_ITEM, SideLink } from '../components/SideLink'
import { ViewBoundary } from '../components/ViewBoundary'
import { devicesWords } from '../document/devices'
import { isActive } from '../document/runState'
import { nameOfPath } from '../document/path'
import { BehaviorList } from '../features/catalogue/BehaviorList'
import { LostCell } from '../features/robots/LostCell'
import { RunList } from '../features/runs/RunList'
import { useGuide } from '../features/stop/guide'
import { StoppedBanner } from '../features/stop/StoppedBanner'
import classes from './App.module.css'
import { Header } from './Header'
import { ConnectionLost } from './ConnectionLost'
import { LogIn } from './LogIn'
import {
  behaviorHref,
  CELL_HREF,
  cellHref,
  editHref,
  goTo,
  PAST_HREF,
  runHref,
  RUNS_HREF,
  SWEEPS_HREF,
  TEACH_HREF,
  useRoute,
  type Route,
} from './route'
import { RoutedPage } from './RoutedPage'
import { SearchPlace } from './SearchPlace'
import { usePageKeys } from './usePageKeys'

const StopGuide = lazyView(async () => (await import('./StopGuide')).StopGuide)
const KeySheet = lazyView(async () => (await import('../features/keys/KeySheet')).KeySheet)
const UsagesDialog = lazyView(async () => (await import('../features/usages/UsagesDialog')).UsagesDialog)
const RealDevicesQuestion = lazyView(async () => (await import('../features/cell/RealDevicesQuestion')).RealDevicesQuestion)
const Tour = lazyView(async () => (await import('../features/tour/Tour')).Tour)

export function App() {
  const route = useRoute()
  const [menuOpen, menu] = useDisclosure(false)
  const runs = useLive((s) => s.runs)
  const session = useSession((s) => s.session)
  const behaviors = useAnswer(behaviorQueries.all())
  useOutdated(queryKeys.behaviors, location.pathname)
  const isNarrow = useMediaQuery('(max-width: 62em)', false, { getInitialValueInEffect: false })
  const shown = shownRun(route, runs)
  const isEditing = route.page === 'edit'
  const isTeaching = route.page === 'teach'
  const isCell = route.page === 'cell'
  const isTouring = useTour((s) => s.isOn)
  const used = useUsages((s) => s.asked)
  const isAsked = useRealDevices((s) => s.answer !== undefined)
  const hasKeySheet = useKeyMap((s) => s.isShown)
  const searchKey = useKeyOf('search').text
  const isStopped = useLive((s) => s.stop !== null)
  const isGuided = useGuide((s) => s.isOpen) && isStopped
  const behaviorId = route.page === 'behavior' || isEditing ? route.id : shown?.behavior

  useEffect(connect, [])
  usePageKeys()
  useEffect(() => watch(shown?.id ?? ''), [shown?.id])
  useEffect(() => showPresence({ document: behaviorId ?? '', node: '', edits: isEditing }), [behaviorId, isEditing])
  useEffect(() => {
    const name = behaviorId ? nameOfPath(behaviorId) : (session?.cell_name ?? '')
    document.title = [name, 'flexcell'].filter(Boolean).join(' · ')
  }, [behaviorId, session])

  function open(href: string): void {
    menu.close()
    goTo(href)
  }

  return (
    <AppShell
      style={{ '--app-shell-border-color': 'var(--line)' }}
      header={{ height: 52 }}
      navbar={{
        width: { base: 220, xl: 290 },
        breakpoint: 'md',
        collapsed: { mobile: !menuOpen, desktop: isEditing || isTeaching || isCell },
      }}
      aside={{ width: { base: 380, xl: 460 }, breakpoint: 'md', collapsed: { mobile: !isGuided, desktop: !isGuided } }}
    >
      <a className={classes.skip} href="#main">
        Skip to the content
      </a>
      <AppShell.Header display="flex" bg="var(--surface)" style={HEADER}>
        <Burger
          opened={menuOpen}
          onClick={menu.toggle}
          hiddenFrom="md"
          size="sm"
          data-tour="menu"
          aria-label={menuOpen ? 'Close the menu' : 'Open the menu'}
        />
        <ViewBoundary name="Header">
          <Header
            cellName={session?.cell_name ?? ''}
            devices={devicesWords(session)}
            mayOperate={session?.role === 'operator'}
            shown={shown}
            // What one may do with a run is shown with it.
            active={session ? runs.filter(isActive) : []}
            isKnown={session !== undefined}
            onHome={() => open('/')}
            isCell={isCell}
            onCell={() => open(CELL_HREF)}
            isTeaching={isTeaching}
            onTeach={() => open(TEACH_HREF)}
            onRun={(id) => open(runHref(id))}
            onRuns={() => open(RUNS_HREF)}
          />
        </ViewBoundary>
      </AppShell.Header>
      <AppShell.Navbar py={14} px="xs" bg="var(--surface)" style={{ gap: 18, overflowY: 'auto' }}>
        <ViewBoundary name="Behaviors">
          <BehaviorList
            behaviors={behaviors.value}
            current={behaviorId}
            href={behaviorHref}
            onOpen={(id) => open(behaviorHref(id))}
            onMade={session?.role === 'operator' ? (id) => open(editHref(id)) : undefined}
          />
        </ViewBoundary>
        <ViewBoundary name="Runs">
          <RunList current={route.page === 'run' ? route.id : undefined} href={runHref} onOpen={(id) => open(runHref(id))} limit={30} />
        </ViewBoundary>
        <div>
          <NavLink
            {...SIDE_ITEM}
            component="button"
            type="button"
            leftSection={<IconSearch size={15} aria-hidden />}
            label={<>Search {searchKey && <Kbd size="xs">{searchKey}</Kbd>}</>}
            onClick={openSearch}
          />
          {SIDE_PAGES.map(({ href, label, icon, pages }) => (
            <SideLink key={href} href={href} label={label} icon={icon} isCurrent={pages.includes(route.page)} onOpen={() => open(href)} />
          ))}
        </div>
      </AppShell.Navbar>
      <AppShell.Main id="main" display="flex" h="100dvh" mih={0} style={{ flexDirection: 'column' }}>
        <NoticePlace>
          <ConnectionLost />
          <StoppedBanner />
          <LogIn />
          <LostCell />
        </NoticePlace>
        <Loading name="This page" of={JSON.stringify(route)}>
          <RoutedPage route={route} shown={shown} session={session} isNarrow={isNarrow ?? false} onOpen={open} />
        </Loading>
      </AppShell.Main>
      <SearchPlace
        pages={ANYWHERE}
        edited={isEditing ? route.id : undefined}
        onOpen={(hit) => (hit.kind === 'state' ? findUsages({ kind: 'state', name: hit.id }) : open(hrefOf(hit)))}
      />
      <AppShell.Aside>
        {isGuided && (
          <ViewBoundary name="Recovery guide">
            <WhileLoading value={null}>
              <StopGuide onOpen={open} />
            </WhileLoading>
          </ViewBoundary>
        )}
      </AppShell.Aside>
      {used && (
        <ViewBoundary name="Usages">
          <WhileLoading value={null}>
            <UsagesDialog asked={used} onOpen={(document, path) => open(editHref(document, path))} />
          </WhileLoading>
        </ViewBoundary>
      )}
      {isAsked && (
        <ViewBoundary name="Real devices">
          <WhileLoading value={null}>
            <RealDevicesQuestion />
          </WhileLoading>
        </ViewBoundary>
      )}
      {hasKeySheet && (
        <ViewBoundary name="Keyboard">
          <WhileLoading value={null}>
            <KeySheet />
          </WhileLoading>
        </ViewBoundary>
      )}
      {isTouring && (
        <ViewBoundary name="Tour">
          <WhileLoading value={null}>
            <Tour page={route.page} id={behaviorId ?? ''} onEdit={(id) => open(editHref(id))} onBehavior={(id) => open(behaviorHref(id))} />
          </WhileLoading>
        </ViewBoundary>
      )}
    </AppShell>
  )
}

/** STOP lies over the end of it. */
const HEADER = { gap: 12, alignItems: 'center', paddingInline: '14px var(--stop-room, 14px)' }

const SIDE_PAGES: readonly { href: string; label: string; icon: ReactNode; pages: readonly Route['page'][] }[] = [
  { href: CELL_HREF, label: 'Cell', icon: <IconCube size={15} aria-hidden />, pages: ['cell'] },
  { href: RUNS_HREF, label: 'All active runs', icon: <IconLayoutGrid size={15} aria-hidden />, pages: ['runs', 'beside'] },
  { href: PAST_HREF, label: 'Past runs and recordings', icon: <IconHistory size={15} aria-hidden />, pages: ['past', 'compare', 'trend'] },
  { href: SWEEPS_HREF, label: 'Sweeps', icon: <IconChartDots size={15} aria-hidden />, pages: ['sweeps', 'sweep'] },
]

const PAGES: readonly PageCommand[] = [
  ['Home', '/'],
  ['Active runs', RUNS_HREF],
  ['Past runs and recordings', PAST_HREF],
  ['Sweeps', SWEEPS_HREF],
  ['Cell', CELL_HREF],
  ['Teach and jog', TEACH_HREF],
].map(([title = '', href = '']) => ({ id: `page:${href}`, title, group: 'Pages', run: () => goTo(href) }))

const HELP: readonly PageCommand[] = [
  {
    id: 'help:usages',
    title: 'Find usages: of a state, behavior, entry or userdata key',
    group: 'Commands',
    run: () => findUsages({ kind: 'state', name: '' }),
  },
  { id: 'help:keys', title: 'Keyboard: all keys, and change them', group: 'Commands', run: () => showKeys() },
]
const ANYWHERE = [...PAGES, ...HELP]

function hrefOf({ kind, id, path }: NameHit): string {
  switch (kind) {
    case 'behavior':
    case 'state':
      return behaviorHref(id)
    case 'node':
      return editHref(id, path)
    case 'run':
      return runHref(id)
    case 'entry':
      return TEACH_HREF
    case 'item':
    case 'topic':
      return cellHref(id, path)
  }
}

/** The run that a page shows: the one of its address; of a behavior the active one, else its newest. */
function shownRun(route: Route, runs: readonly RunView[]): RunView | undefined {
  if (route.page === 'run') return runs.find((run) => run.id === route.id)
  if (route.page !== 'behavior') return undefined
  const own = runs.filter((run) => run.behavior === route.id)
  return own.find(isActive) ?? own[0]
}
