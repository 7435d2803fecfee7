/** The whole page: connection, session, navigation, and the page of the address. */
import { AppShell, Burger } from '@mantine/core'
import { useDisclosure, useMediaQuery } from '@mantine/hooks'
import { IconHistory, IconLayoutGrid } from '@tabler/icons-react'
import { lazy, Suspense, useEffect } from 'react'
import { api } from '../api/client'
import { connect, useLive, watch } from '../api/live'
import { useTour } from '../api/tour'
import type { RunLine } from '../api/types'
import { PageLink } from '../components/PageLink'
import { isActive } from '../document/live'
import { BehaviorList } from '../features/catalogue/BehaviorList'
import { FromDemonstration } from '../features/demonstration/FromDemonstration'
import { RunList } from '../features/runs/RunList'
import { Header } from './Header'
import { HomePage } from './HomePage'
import { Interruption } from './Interruption'
import { behaviorHref, editHref, goTo, PAST_HREF, runHref, RUNS_HREF, TEACH_HREF, useRoute, type Route } from './route'
import { useFetched } from './useFetched'

/** Brings the canvas with it, which the first page does not need. */
const BehaviorPage = lazy(async () => ({ default: (await import('./BehaviorPage')).BehaviorPage }))
const TeachPage = lazy(async () => ({ default: (await import('./TeachPage')).TeachPage }))
const PastPage = lazy(async () => ({ default: (await import('./PastPage')).PastPage }))
const PastRunsPage = lazy(async () => ({ default: (await import('./PastRunsPage')).PastRunsPage }))
const RunsPage = lazy(async () => ({ default: (await import('./RunsPage')).RunsPage }))
const BesidePage = lazy(async () => ({ default: (await import('./BesidePage')).BesidePage }))
const EditorPage = lazy(async () => ({ default: (await import('../features/editor/EditorPage')).EditorPage }))
const EditorPreview = lazy(async () => ({ default: (await import('./EditorPreview')).EditorPreview }))
const Tour = lazy(async () => ({ default: (await import('../features/tour/Tour')).Tour }))

export function App() {
  const route = useRoute()
  const [menuOpen, menu] = useDisclosure(false)
  const runs = useLive((s) => s.runs)
  // Whoever writes a file, here or elsewhere: the list is as the files are.
  const written = useLive((s) => JSON.stringify(s.documents))
  const session = useFetched('session', api.session)
  const behaviors = useFetched('behaviors', api.behaviors, `${location.pathname} ${written}`)
  const isNarrow = useMediaQuery('(max-width: 62em)', false, { getInitialValueInEffect: false })
  const shown = shownRun(route, runs)
  const isEditing = route.page === 'edit'
  const isTeaching = route.page === 'teach'
  const isOfRuns = route.page === 'runs' || route.page === 'beside'
  const isTouring = useTour((s) => s.isOn)
  // A run that this server has not started may be in its journal.
  const knowsRuns = useLive((s) => s.knowsRuns)
  const isPast = route.page === 'recording' || (route.page === 'run' && knowsRuns && !shown)
  const behaviorId = route.page === 'behavior' || isEditing ? route.id : shown?.behavior

  useEffect(connect, [])
  useEffect(() => watch(shown?.id ?? ''), [shown?.id])
  useEffect(() => {
    const name = behaviorId ? (behaviorId.split('/').pop() ?? '') : (session.value?.cell_name ?? '')
    document.title = [name, 'flexcell'].filter(Boolean).join(' · ')
  }, [behaviorId, session.value])

  function open(href: string): void {
    menu.close()
    goTo(href)
  }

  return (
    <AppShell
      header={{ height: 52 }}
      navbar={{ width: { base: 220, xl: 290 }, breakpoint: 'md', collapsed: { mobile: !menuOpen, desktop: isEditing || isTeaching } }}
    >
      <a className="skip-link" href="#main">
        Skip to the content
      </a>
      <AppShell.Header className="app-header">
        <Burger opened={menuOpen} onClick={menu.toggle} hiddenFrom="md" size="sm" aria-label={menuOpen ? 'Close the menu' : 'Open the menu'} />
        <Header
          cellName={session.value?.cell_name ?? ''}
          mayOperate={session.value?.role === 'operator'}
          shown={shown}
          active={runs.filter(isActive)}
          onHome={() => open('/')}
          isTeaching={isTeaching}
          onTeach={() => open(TEACH_HREF)}
          onRun={(id) => open(runHref(id))}
          onRuns={() => open(RUNS_HREF)}
        />
      </AppShell.Header>
      <AppShell.Navbar className="app-navbar">
        <BehaviorList
          behaviors={behaviors.value ?? []}
          current={behaviorId}
          href={behaviorHref}
          onOpen={(id) => open(behaviorHref(id))}
          onMade={session.value?.role === 'operator' ? (id) => open(editHref(id)) : undefined}
        />
        <RunList current={route.page === 'run' ? route.id : undefined} href={runHref} onOpen={(id) => open(runHref(id))} limit={30} />
        <div>
          <PageLink href={RUNS_HREF} className={sideItem(isOfRuns)} isCurrent={isOfRuns} onOpen={() => open(RUNS_HREF)}>
            <IconLayoutGrid size={15} aria-hidden />
            <span className="side-item-name">All runs under way</span>
          </PageLink>
          <PageLink href={PAST_HREF} className={sideItem(route.page === 'past')} isCurrent={route.page === 'past'} onOpen={() => open(PAST_HREF)}>
            <IconHistory size={15} aria-hidden />
            <span className="side-item-name">Past runs and recordings</span>
          </PageLink>
        </div>
      </AppShell.Navbar>
      <AppShell.Main id="main" className="app-main">
        <Interruption />
        {isEditing ? (
          <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
            <EditorPage
              key={route.id}
              id={route.id}
              mayEdit={session.value?.role === 'operator'}
              isNarrow={isNarrow ?? false}
              onRun={() => open(behaviorHref(route.id))}
              onOpen={(id, node) => open(editHref(id, node))}
              onGone={() => open('/')}
              hasCellView={session.value?.has_cell_view ?? false}
              preview={
                <Suspense fallback={null}>
                  <EditorPreview isNarrow={isNarrow ?? false} />
                </Suspense>
              }
              libraryTools={session.value?.role === 'operator' ? <FromDemonstration onMade={(id) => open(editHref(id))} /> : undefined}
            />
          </Suspense>
        ) : isTeaching ? (
          <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
            <TeachPage session={session.value} isNarrow={isNarrow ?? false} />
          </Suspense>
        ) : isPast ? (
          <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
            <PastPage
              key={route.id}
              id={route.id}
              isRecording={route.page === 'recording'}
              session={session.value}
              isNarrow={isNarrow}
              onAll={() => open(PAST_HREF)}
            />
          </Suspense>
        ) : route.page === 'run' && !shown ? (
          <div className="page-wait" role="status" aria-label="Loading" />
        ) : route.page === 'past' ? (
          <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
            <PastRunsPage onOpen={open} />
          </Suspense>
        ) : route.page === 'runs' ? (
          <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
            <RunsPage onOpen={open} />
          </Suspense>
        ) : route.page === 'beside' ? (
          <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
            <BesidePage left={route.left} right={route.right} isNarrow={isNarrow ?? false} onOpen={open} />
          </Suspense>
        ) : behaviorId ? (
          <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
            <BehaviorPage
              key={behaviorId}
              id={behaviorId}
              run={shown}
              active={runs.filter(isActive)}
              session={session.value}
              isNarrow={isNarrow}
              onStarted={() => open(behaviorHref(behaviorId))}
              onEdit={(node) => open(editHref(behaviorId, node))}
            />
          </Suspense>
        ) : (
          <HomePage hasCellView={session.value?.has_cell_view ?? false} onOpenRun={(id) => open(runHref(id))} />
        )}
      </AppShell.Main>
      {isTouring && (
        <Suspense fallback={null}>
          <Tour page={route.page} id={behaviorId ?? ''} onEdit={(id) => open(editHref(id))} onBehavior={(id) => open(behaviorHref(id))} />
        </Suspense>
      )}
    </AppShell>
  )
}

function sideItem(isCurrent: boolean): string {
  return `side-item run-item${isCurrent ? ' is-current' : ''}`
}

/** The run that a page shows: the one of its address; of a behavior the active one, else its newest. */
function shownRun(route: Route, runs: readonly RunLine[]): RunLine | undefined {
  if (route.page === 'run') return runs.find((run) => run.id === route.id)
  if (route.page !== 'behavior') return undefined
  const own = runs.filter((run) => run.behavior === route.id)
  return own.find(isActive) ?? own[0]
}
